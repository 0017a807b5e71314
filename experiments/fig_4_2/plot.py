"""The measuring set-up: an inflated sheet in its clamp with its scan, the loading steps, and what is measured."""

import sys

import numpy as np
from matplotlib import colormaps

sys.path.insert(0, "scripts")
from plot_style import COLORS, plt, read_table, run

SHOWN_STEP = 8
VIEW_AZIMUTH, VIEW_HEIGHT = -57, 18  # [degrees]
RADIUS = 3.0  # of the opening [cm]


def table_of(results, name):
    return {key: np.array(values) for key, values in read_table(results / f"{name}.csv").items()}


def draw_clamp(axes, first_angle, last_angle, zorder):
    r, angle = np.meshgrid([RADIUS, RADIUS, RADIUS + 0.8, RADIUS + 0.8], np.linspace(first_angle, last_angle, 61))
    z = np.tile([0, 0.15, 0.15, 0], (len(angle), 1))
    axes.plot_surface(r * np.cos(angle), r * np.sin(angle), z, color="0.6", linewidth=0, rstride=1, cstride=1,
                      zorder=zorder)


def draw_scan(axes, profiles, scan):
    """The sheet of one step, turned about its axis from its meridian, and the points scanned on it."""
    azimuth = np.radians(VIEW_AZIMUTH)
    chosen = profiles["step"] == SHOWN_STEP
    r, height = 100 * profiles["radius [m]"][chosen], 100 * profiles["height [m]"][chosen]
    angle = np.linspace(0, 2 * np.pi, 121)
    draw_clamp(axes, azimuth + np.pi / 2, azimuth + 3 * np.pi / 2, zorder=1)
    axes.plot_surface(np.outer(r, np.cos(angle)), np.outer(r, np.sin(angle)), np.outer(height, np.ones_like(angle)),
                      color="#a9c7dd", linewidth=0, rstride=1, cstride=1, antialiased=False, zorder=2)
    points = scan["step"] == SHOWN_STEP
    x, y, z = (100 * scan[f"{axis} [m]"][points] for axis in "xyz")
    # What faces the eye: within the half of the sheet on its side, or on top.
    towards = (x * np.cos(azimuth) + y * np.sin(azimuth)) * np.cos(np.radians(VIEW_HEIGHT)) / r.max() + 0.45 * (
        z / height.max() - 0.45)
    axes.scatter(*(v[towards > 0] for v in (x, y, z)), s=1.6, color=COLORS[1], linewidth=0, depthshade=False, zorder=3)
    draw_clamp(axes, azimuth - np.pi / 2, azimuth + np.pi / 2, zorder=4)
    axes.set_box_aspect((1, 1, 0.62), zoom=1.3)
    axes.set_xlim(-4, 4), axes.set_ylim(-4, 4), axes.set_zlim(0, 4.96)
    axes.view_init(elev=VIEW_HEIGHT, azim=VIEW_AZIMUTH)
    axes.set_axis_off()
    axes.set_title(f"step {SHOWN_STEP}: clamp, sheet and scanned points", fontsize=9)


def draw_steps(axes, profiles, scan):
    pressure = profiles["pressure [Pa]"]
    for step in np.unique(profiles["step"]):
        chosen = profiles["step"] == step
        color = colormaps["viridis"](pressure[chosen][0] / pressure.max())
        r, z = 100 * profiles["radius [m]"][chosen], 100 * profiles["height [m]"][chosen]
        axes.plot(np.r_[-r[::-1], r], np.r_[z[::-1], z], color=color, linewidth=1.1)
    near_cut = np.abs(scan["y [m]"]) < 1e-3
    axes.plot(100 * scan["x [m]"][near_cut], 100 * scan["z [m]"][near_cut], ".", color=COLORS[1], markersize=2.5,
              label="scan of steps 4, 8, 12, 2 mm about the cut")
    for side in (-1, 1):
        axes.fill_between([side * RADIUS, side * (RADIUS + 0.8)], 0, 0.15, color="0.45")
    axes.fill_between([-RADIUS - 0.8, RADIUS + 0.8], -0.3, -0.02, color="0.8")
    axes.set_aspect("equal")
    axes.set_xlabel("across the opening [cm]")
    axes.set_ylabel("height [cm]")
    axes.set_title("twelve equal steps of volume, coloured by pressure", fontsize=9)
    axes.set_ylim(-0.35, 6.0)
    axes.legend(loc="upper center", fontsize=7)


def draw_curves(axes, measured, exact):
    for color, thickness in zip(COLORS, np.unique(exact["thickness [m]"])):
        curve = exact["thickness [m]"] == thickness
        axes.plot(exact["pressure [Pa]"][curve] / 1e3, exact["extension"][curve], color=color, linewidth=1,
                  label=f"{1e3 * thickness:g} mm")
        chosen = measured["thickness [m]"] == thickness
        axes.plot(measured["pressure [Pa]"][chosen] / 1e3, measured["extension"][chosen], "o", color=color,
                  markersize=2.5, markerfacecolor="white", markeredgewidth=0.7)
    axes.set_xlabel("pressure [kPa]")
    axes.set_ylabel("averaged extension ratio (4.8) [1]")
    axes.set_title("points: samples; lines: exact, nominal thickness", fontsize=9)
    axes.legend(title="thickness", fontsize=8)


def draw(results):
    profiles, scan = table_of(results, "profiles"), table_of(results, "scan")
    figure = plt.figure(figsize=(12.5, 4.2))
    grid = figure.add_gridspec(1, 3, width_ratios=(1, 1.25, 1.1))
    draw_scan(figure.add_subplot(grid[0], projection="3d", computed_zorder=False), profiles, scan)
    draw_steps(figure.add_subplot(grid[1]), profiles, scan)
    draw_curves(figure.add_subplot(grid[2]), table_of(results, "extension"), table_of(results, "exact"))
    return figure


run(draw)

#include "page.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <fmt/format.h>
#include <vtkActor.h>
#include <vtkActor2D.h>
#include <vtkCamera.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkImageShrink3D.h>
#include <vtkLight.h>
#include <vtkLookupTable.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkPlaneSource.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkPolyDataMapper2D.h>
#include <vtkPolyDataNormals.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>
#include <vtkWindowToImageFilter.h>
#include <vtkXMLPolyDataReader.h>

#include "color_map.hpp"
#include "softform/core/error.hpp"

namespace softform::render {
namespace {

namespace fs = std::filesystem;
using Vec3 = Eigen::Vector3d;
using Surface = vtkSmartPointer<vtkPolyData>;

/// Everything is drawn this many times larger and averaged: smooth edges whatever the graphics driver.
constexpr int supersampling = 2;
/// Sizes as fractions of the picture's width.
constexpr double margin = 0.012, gutter = 0.018, label_space = 0.034, caption_space = 0.028, bar_space = 0.07;
constexpr double font_size = 0.013;
/// The font of the plots (Debian's fonts-dejavu-core); VTK's own where it is missing.
constexpr const char* plain_font = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
constexpr const char* bold_font = "/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf";
/// Sharp edges stay sharp: normals are averaged across edges that bend less.
constexpr double feature_angle_degrees = 50;

/// A rectangle of the page [px], y upwards.
struct Box {
  double x, y, width, height;
};

struct View {
  Vec3 towards_eye, up, right;
};

View view_of(const Row& row)
{
  const Vec3 towards_eye = Vec3(row.view.data()).normalized();
  const Vec3 right = Vec3(row.up.data()).cross(towards_eye).normalized();
  return {towards_eye, towards_eye.cross(right), right};
}

Surface read_surface(const fs::path& file)
{
  if (!fs::exists(file)) throw InputError(fmt::format("{}: there is no such file; run the experiment", file.string()));
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  Surface surface = reader->GetOutput();
  if (surface->GetNumberOfPolys() == 0) throw InputError(fmt::format("{}: holds no polygons", file.string()));
  return surface;
}

/// Extent of a surface along the view's right, up and eye directions.
Eigen::AlignedBox3d projected_box(vtkPolyData& surface, const View& view)
{
  Eigen::AlignedBox3d box;
  for (vtkIdType i = 0; i < surface.GetNumberOfPoints(); ++i) {
    const Vec3 point = Eigen::Map<const Vec3>(surface.GetPoint(i));
    box.extend(Vec3(point.dot(view.right), point.dot(view.up), point.dot(view.towards_eye)));
  }
  return box;
}

/// Key from the upper left, a weak fill from the right, and some light from below against black undersides.
/// All fixed to the camera.
void add_lights(vtkRenderer& renderer)
{
  renderer.AutomaticLightCreationOff();
  const auto add = [&](double x, double y, double z, double intensity) {
    vtkNew<vtkLight> light;
    light->SetLightTypeToCameraLight();
    light->SetPosition(x, y, z);
    light->SetFocalPoint(0, 0, 0);
    light->SetIntensity(intensity);
    renderer.AddLight(light);
  };
  add(-0.55, 0.8, 1.1, 0.72);
  add(1.0, 0.2, 0.9, 0.30);
  add(0.1, -0.9, 0.9, 0.16);
}

/// Draws a layout into one off-screen window.
class Page {
 public:
  Page(const Layout& layout, fs::path results) : layout_(layout), results_(std::move(results)) {}

  void draw(const fs::path& png)
  {
    window_->SetOffScreenRendering(1);
    window_->SetNumberOfLayers(2);
    window_->SetMultiSamples(0);
    load_surfaces();
    place_rows();
    window_->SetSize(int(width_), int(height_));
    add_ground_and_text_layer();
    draw_column_titles();
    for (std::size_t r = 0; r < layout_.rows.size(); ++r) draw_row(r);
    window_->Render();
    write(png);
  }

 private:
  double px(double fraction) const { return fraction * width_; }

  void load_surfaces()
  {
    for (const Row& row : layout_.rows) {
      auto& surfaces = surfaces_.emplace_back();
      for (const auto& cell : row.cells) surfaces.push_back(cell ? read_surface(results_ / cell->surface) : Surface());
    }
  }

  bool has_row_titles() const
  {
    return std::any_of(layout_.rows.begin(), layout_.rows.end(), [](const Row& row) { return !row.title.empty(); });
  }
  bool has_column_titles() const
  {
    return std::any_of(layout_.columns.begin(), layout_.columns.end(), [](const auto& c) { return !c.title.empty(); });
  }

  /// Row heights follow the models' shapes: every model fills its cell's width, or one and a quarter of it in height.
  void place_rows()
  {
    width_ = double(layout_.width) * supersampling;
    const auto columns = double(layout_.columns.size());
    label_width_ = has_row_titles() ? px(label_space) : 0;
    block_width_ = (width_ - 2 * px(margin) - (layout_.blocks - 1) * px(gutter)) / layout_.blocks;
    cell_width_ = (block_width_ - label_width_ - (columns - 1) * px(gutter)) / columns;
    const double first_row = px(margin) + (has_column_titles() ? px(label_space) : 0);
    double from_top = first_row;
    for (std::size_t r = 0; r < layout_.rows.size(); ++r) {
      if (r % rows_per_block() == 0) from_top = first_row;
      const View view = view_of(layout_.rows[r]);
      Eigen::Vector2d largest(1e-12, 1e-12);
      for (const Surface& surface : surfaces_[r])
        if (surface) largest = largest.cwiseMax(projected_box(*surface, view).sizes().head<2>());
      const double per_metre = std::min(cell_width_ / largest.x(), 1.25 * cell_width_ / largest.y()) * 0.96;
      RowPlace place{.per_metre = per_metre, .picture_height = std::ceil(largest.y() * per_metre / 0.96)};
      for (const auto& cell : layout_.rows[r].cells) {
        if (cell && !cell->title.empty()) place.caption_height = px(caption_space);
        if (cell && cell->scalar && has_bar(*cell->scalar)) place.bar_height = px(bar_space);
      }
      from_top += place.picture_height;
      place.from_top = from_top;  // the picture's lower edge
      from_top += place.caption_height + place.bar_height + px(gutter);
      height_ = std::max(height_, from_top);
      places_.push_back(place);
    }
    height_ = supersampling * std::ceil((height_ - px(gutter) + px(margin)) / supersampling);
  }

  /// White ground below all cells, text above them.
  void add_ground_and_text_layer()
  {
    vtkNew<vtkRenderer> ground;
    ground->SetBackground(1, 1, 1);
    window_->AddRenderer(ground);
    text_->SetLayer(1);
    text_->InteractiveOff();
    window_->AddRenderer(text_);
  }

  void add_text(const std::string& text, double x, double y, double degrees, bool bold)
  {
    if (text.empty()) return;
    vtkNew<vtkTextActor> actor;
    actor->SetInput(text.c_str());
    vtkTextProperty& style = *actor->GetTextProperty();
    set_font(style, bold);
    style.SetJustificationToCentered();
    style.SetVerticalJustificationToCentered();
    style.SetOrientation(degrees);
    actor->SetPosition(x, y);
    text_->AddActor2D(actor);
  }

  void set_font(vtkTextProperty& style, bool bold) const
  {
    style.SetFontFamilyToArial();
    if (fs::exists(bold ? bold_font : plain_font)) {
      style.SetFontFamily(VTK_FONT_FILE);
      style.SetFontFile(bold ? bold_font : plain_font);
    }
    style.SetFontSize(int(px(font_size)));
    style.SetColor(0.1, 0.1, 0.1);
  }

  std::size_t rows_per_block() const
  {
    return (layout_.rows.size() + std::size_t(layout_.blocks) - 1) / std::size_t(layout_.blocks);
  }
  double block_x(std::size_t block) const { return px(margin) + double(block) * (block_width_ + px(gutter)); }
  double column_x(std::size_t block, std::size_t column) const
  {
    return block_x(block) + label_width_ + double(column) * (cell_width_ + px(gutter));
  }

  void draw_column_titles()
  {
    const double y = height_ - px(margin) - px(label_space) / 2;
    for (std::size_t block = 0; block * rows_per_block() < layout_.rows.size(); ++block)
      for (std::size_t c = 0; c < layout_.columns.size(); ++c)
        add_text(layout_.columns[c].title, column_x(block, c) + cell_width_ / 2, y, 0, true);
  }

  void draw_row(std::size_t r)
  {
    const Row& row = layout_.rows[r];
    const RowPlace& place = places_[r];
    const double bottom = height_ - place.from_top;
    const std::size_t block = r / rows_per_block();
    add_text(row.title, block_x(block) + px(label_space) / 2, bottom + place.picture_height / 2, 90, true);
    for (std::size_t c = 0; c < row.cells.size(); ++c) {
      if (!row.cells[c]) continue;
      const Box box{column_x(block, c), bottom, cell_width_, place.picture_height};
      const auto& color = row.cells[c]->color.value_or(layout_.columns[c].color);
      draw_cell(*row.cells[c], color, *surfaces_[r][c], view_of(row), place, box);
      add_text(row.cells[c]->title, box.x + box.width / 2, bottom - place.caption_height / 2, 0, false);
    }
  }

  struct RowPlace {
    double per_metre, picture_height;
    double from_top = 0, caption_height = 0, bar_height = 0;
  };

  void draw_cell(const Cell& cell, const Color& color, vtkPolyData& surface, const View& view, const RowPlace& place,
                 const Box& box)
  {
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->ScalarVisibilityOff();
    if (cell.scalar) {
      const auto table = lookup_table(cell.scalar->map, activate_field(surface, *cell.scalar, results_ / cell.surface));
      mapper->ScalarVisibilityOn();
      mapper->SetLookupTable(table);
      mapper->UseLookupTableScalarRangeOn();
      mapper->InterpolateScalarsBeforeMappingOn();
      if (has_bar(*cell.scalar))
        draw_bar(*cell.scalar, *table,
                 {box.x, box.y - place.caption_height - place.bar_height, box.width, place.bar_height});
    }
    vtkNew<vtkPolyDataNormals> normals;
    normals->SetInputData(&surface);
    normals->SetFeatureAngle(feature_angle_degrees);
    mapper->SetInputConnection(normals->GetOutputPort());

    vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    set_material(*actor->GetProperty(), color, cell.edges);
    // Colours that stand for numbers are shaded less.
    if (cell.scalar) actor->GetProperty()->SetAmbient(0.45);
    if (cell.scalar) actor->GetProperty()->SetDiffuse(0.6);
    vtkNew<vtkRenderer> renderer;
    renderer->SetBackground(1, 1, 1);
    renderer->SetViewport(box.x / width_, box.y / height_, (box.x + box.width) / width_,
                          (box.y + box.height) / height_);
    renderer->AddActor(actor);
    add_lights(*renderer);
    aim(*renderer, projected_box(surface, view), view, box.height / place.per_metre);
    window_->AddRenderer(renderer);
  }

  static void set_material(vtkProperty& material, const Color& color, bool edges)
  {
    material.SetColor(color[0], color[1], color[2]);
    material.SetInterpolationToPhong();
    material.SetAmbient(0.28);
    material.SetDiffuse(0.82);
    material.SetSpecular(0.08);
    material.SetSpecularPower(20);
    material.SetEdgeVisibility(edges);
    material.SetEdgeColor(0.25, 0.25, 0.28);
    material.SetLineWidth(supersampling * 1.0f);
  }

  /// Parallel projection centred on the surface's silhouette; `height` is the viewport's in metres.
  static void aim(vtkRenderer& renderer, const Eigen::AlignedBox3d& box, const View& view, double height)
  {
    const Vec3 middle = box.center();
    const double depth = box.sizes().norm();
    const Vec3 centre = middle.x() * view.right + middle.y() * view.up + middle.z() * view.towards_eye;
    const Vec3 eye = centre + 2 * depth * view.towards_eye;
    vtkCamera& camera = *renderer.GetActiveCamera();
    camera.ParallelProjectionOn();
    camera.SetParallelScale(height / 2);
    camera.SetFocalPoint(centre.data());
    camera.SetPosition(eye.data());
    camera.SetViewUp(view.up.data());
    camera.SetClippingRange(0.5 * depth, 3.5 * depth);
  }

  static bool has_bar(const Scalar& scalar) { return scalar.map != ColorMap::Categories; }

  /// The bar, five numbers below it, and below them the title with the unit.
  void draw_bar(const Scalar& scalar, vtkLookupTable& table, const Box& box)
  {
    const double left = box.x + 0.08 * box.width;
    const double width = 0.84 * box.width;
    const double top = box.y + 0.93 * box.height;
    const double bottom = box.y + 0.70 * box.height;
    vtkNew<vtkPlaneSource> plane;
    plane->SetOrigin(left, bottom, 0);
    plane->SetPoint1(left + width, bottom, 0);
    plane->SetPoint2(left, top, 0);
    plane->SetXResolution(int(table.GetNumberOfTableValues()));
    plane->Update();
    vtkNew<vtkPolyData> bar;
    bar->ShallowCopy(plane->GetOutput());
    vtkNew<vtkDoubleArray> values;
    const double* range = table.GetRange();
    const auto value_at = [&](double fraction) { return range[0] + fraction * (range[1] - range[0]); };
    for (vtkIdType i = 0; i < bar->GetNumberOfCells(); ++i)
      values->InsertNextValue(value_at((double(i) + 0.5) / double(bar->GetNumberOfCells())));
    bar->GetCellData()->SetScalars(values);
    vtkNew<vtkPolyDataMapper2D> mapper;
    mapper->SetInputData(bar);
    mapper->SetLookupTable(&table);
    mapper->UseLookupTableScalarRangeOn();
    vtkNew<vtkActor2D> actor;
    actor->SetMapper(mapper);
    text_->AddActor2D(actor);

    for (int k = 0; k <= 4; ++k)
      add_text(fmt::format("{:.3g}", value_at(k / 4.0)), left + k * width / 4, box.y + 0.50 * box.height, 0, false);
    const auto title = scalar.unit.empty() ? scalar.title : fmt::format("{} [{}]", scalar.title, scalar.unit);
    add_text(title, left + width / 2, box.y + 0.20 * box.height, 0, false);
  }

  void write(const fs::path& png)
  {
    vtkNew<vtkWindowToImageFilter> image;
    image->SetInput(window_);
    image->ReadFrontBufferOff();
    vtkNew<vtkImageShrink3D> shrink;
    shrink->SetInputConnection(image->GetOutputPort());
    shrink->SetShrinkFactors(supersampling, supersampling, 1);
    shrink->AveragingOn();
    vtkNew<vtkPNGWriter> writer;
    writer->SetInputConnection(shrink->GetOutputPort());
    writer->SetFileName(png.c_str());
    writer->Write();
    if (writer->GetErrorCode() != 0 || !fs::exists(png))
      throw InputError(fmt::format("{}: cannot be written; check the folder", png.string()));
  }

  const Layout& layout_;
  fs::path results_;
  vtkNew<vtkRenderWindow> window_;
  vtkNew<vtkRenderer> text_;
  std::vector<std::vector<Surface>> surfaces_;
  std::vector<RowPlace> places_;
  double width_ = 0, height_ = 0, label_width_ = 0, block_width_ = 0, cell_width_ = 0;
};

}  // namespace

void draw_page(const Layout& layout, const fs::path& results, const fs::path& png) { Page(layout, results).draw(png); }

}  // namespace softform::render

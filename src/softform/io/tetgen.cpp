#include "softform/io/tetgen.hpp"

#include <filesystem>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <sstream>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "softform/core/error.hpp"
#include "softform/io/mesh_io.hpp"
#include "softform/io/text_file.hpp"
#include "softform/mesh/check.hpp"

extern char** environ;

namespace softform {
namespace {

class TemporaryFolder {
 public:
  TemporaryFolder()
  {
    std::string name = (std::filesystem::temp_directory_path() / "softform-tetgen-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr)
      throw InputError(fmt::format("{}: cannot make a folder there; set TMPDIR to one that can be written", name));
    path_ = name;
  }
  ~TemporaryFolder()
  {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

// Runs a program without a shell, its output into a file. Returns the wait status, or -1 when it cannot be started.
int run(const std::vector<std::string>& words, const std::filesystem::path& log)
{
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_adddup2(&files, STDOUT_FILENO, STDERR_FILENO);
  pid_t child = 0;
  const int error = posix_spawnp(&child, arguments[0], &files, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  if (error != 0) return -1;
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

// The numbers of a .node or .ele file: a header whose first two numbers are rows and columns, then an index and the
// columns a row; comments start with '#'.
std::vector<std::vector<double>> read_table(const std::filesystem::path& file, std::size_t columns)
{
  std::istringstream lines(read_text(file));
  std::vector<std::vector<double>> rows;
  bool is_header = true;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line.substr(0, line.find('#')));
    double first = 0;
    if (!(words >> first)) continue;
    if (std::exchange(is_header, false)) continue;
    std::vector<double> row(columns);
    for (double& value : row)
      if (!(words >> value)) throw InputError(fmt::format("{}: row {} is not complete", file.string(), rows.size()));
    rows.push_back(std::move(row));
  }
  return rows;
}

SimplexMesh<3> read_result(const std::filesystem::path& folder)
{
  const auto nodes = read_table(folder / "surface.1.node", 3), elements = read_table(folder / "surface.1.ele", 4);
  SimplexMesh<3> mesh;
  mesh.positions.resize(3 * std::ssize(nodes));
  for (std::size_t i = 0; i < nodes.size(); ++i)
    mesh.positions.segment<3>(3 * Eigen::Index(i)) << nodes[i][0], nodes[i][1], nodes[i][2];
  mesh.elements.resize(std::ssize(elements), 4);
  for (std::size_t e = 0; e < elements.size(); ++e) {
    for (std::size_t k = 0; k < 4; ++k) mesh.elements(Eigen::Index(e), Eigen::Index(k)) = int(elements[e][k]);
    const auto corner = [&](int k) { return vertex(mesh.positions, mesh.elements(Eigen::Index(e), k)); };
    const Vec3 u = corner(1) - corner(0), v = corner(2) - corner(0), w = corner(3) - corner(0);
    if (u.cross(v).dot(w) < 0) std::swap(mesh.elements(Eigen::Index(e), 2), mesh.elements(Eigen::Index(e), 3));
  }
  return mesh;
}

}  // namespace

SimplexMesh<3> tetrahedralize(const TriangleMesh& surface, const std::string& name,
                              const TetrahedralizeOptions& options)
{
  require_closed_surface(surface, name);
  const TemporaryFolder folder;
  const auto file = folder.path() / "surface.off";
  write_mesh(file, surface);
  // p: a closed surface, Y: its edges stay, q: quality, a: volume, z: counted from 0, Q: quiet.
  std::string switches = fmt::format("-pYzQq{}", options.radius_edge_ratio);
  if (options.largest_volume > 0) switches += fmt::format("a{:.17f}", options.largest_volume);
  const int status = run({options.program, switches, file.string()}, folder.path() / "log.txt");
  if (status == -1 || (WIFEXITED(status) && WEXITSTATUS(status) == 127))
    throw InputError(fmt::format("'{}' cannot be run: install TetGen (Debian: tetgen)", options.program));
  if (status != 0 || !std::filesystem::exists(folder.path() / "surface.1.ele"))
    throw InputError(fmt::format("{}: TetGen {} on this surface; remesh it to better triangles", name,
                                 WIFSIGNALED(status) ? "crashed" : "failed"));
  return read_result(folder.path());
}

SimplexMesh<3> tetrahedralize_to_count(const TriangleMesh& surface, const std::string& name, int count,
                                       double tolerance, const TetrahedralizeOptions& options)
{
  TetrahedralizeOptions trial = options;
  double low = 0, high = std::numeric_limits<double>::infinity();
  trial.largest_volume = 2 * enclosed_volume(surface) / count;
  SimplexMesh<3> best;
  for (int k = 0; k < 20; ++k) {
    SimplexMesh<3> mesh = tetrahedralize(surface, name, trial);
    const int found = mesh.element_count();
    if (best.element_count() == 0 || std::abs(found - count) < std::abs(best.element_count() - count))
      best = std::move(mesh);
    if (std::abs(best.element_count() - count) <= tolerance * count) break;
    (found > count ? low : high) = trial.largest_volume;
    trial.largest_volume = std::isinf(high) ? 2 * low : low == 0 ? high / 2 : std::sqrt(low * high);
  }
  return best;
}

}  // namespace softform

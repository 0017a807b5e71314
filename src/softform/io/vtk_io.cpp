#include "softform/io/vtk_io.hpp"

#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCommand.h>
#include <vtkDoubleArray.h>
#include <vtkErrorCode.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLPolyDataWriter.h>
#include <vtkXMLUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include "softform/core/error.hpp"
#include "softform/io/atomic_write.hpp"
#include "softform/io/text_file.hpp"

namespace softform {
namespace {

/// Keeps VTK's complaints off the terminal: our own message follows.
class SilentObserver : public vtkCommand {
 public:
  static SilentObserver* New() { return new SilentObserver; }
  void Execute(vtkObject*, unsigned long, void*) override {}
};

void add_fields(const std::vector<Field>& fields, vtkDataSetAttributes& target)
{
  for (const Field& field : fields) {
    vtkNew<vtkDoubleArray> array;
    array->SetName(field.name.c_str());
    array->SetNumberOfComponents(static_cast<int>(field.values.cols()));
    array->SetNumberOfTuples(field.values.rows());
    for (Eigen::Index i = 0; i < field.values.rows(); ++i)
      for (Eigen::Index k = 0; k < field.values.cols(); ++k)
        array->SetComponent(i, static_cast<int>(k), field.values(i, k));
    target.AddArray(array);
  }
}

std::vector<Field> fields_of(vtkDataSetAttributes& source)
{
  std::vector<Field> fields;
  for (int f = 0; f < source.GetNumberOfArrays(); ++f) {
    vtkDataArray* array = source.GetArray(f);
    if (array == nullptr || array->GetName() == nullptr) continue;
    Field field{array->GetName(), Eigen::MatrixXd(array->GetNumberOfTuples(), array->GetNumberOfComponents())};
    for (Eigen::Index i = 0; i < field.values.rows(); ++i)
      for (Eigen::Index k = 0; k < field.values.cols(); ++k)
        field.values(i, k) = array->GetComponent(i, static_cast<int>(k));
    fields.push_back(std::move(field));
  }
  return fields;
}

vtkNew<vtkPolyData> to_polydata(const TriangleMesh& mesh)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(mesh.vertices.rows());
  for (Eigen::Index i = 0; i < mesh.vertices.rows(); ++i) points->SetPoint(i, mesh.vertices.row(i).data());
  vtkNew<vtkCellArray> cells;
  for (Eigen::Index t = 0; t < mesh.triangles.rows(); ++t)
    cells->InsertNextCell({mesh.triangles(t, 0), mesh.triangles(t, 1), mesh.triangles(t, 2)});
  vtkNew<vtkPolyData> surface;
  surface->SetPoints(points);
  surface->SetPolys(cells);
  return surface;
}

template <int dim>
vtkNew<vtkUnstructuredGrid> to_grid(const SimplexMesh<dim>& mesh)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (int i = 0; i < mesh.vertex_count(); ++i) {
    Vec3 X = Vec3::Zero();
    X.head<dim>() = mesh.positions.template segment<dim>(dim * i);
    points->InsertNextPoint(X.data());
  }
  vtkNew<vtkUnstructuredGrid> solid;
  solid->SetPoints(points);
  for (int e = 0; e < mesh.element_count(); ++e) {
    vtkNew<vtkIdList> corners;
    for (int k = 0; k <= dim; ++k) corners->InsertNextId(mesh.elements(e, k));
    solid->InsertNextCell(dim == 3 ? VTK_TETRA : VTK_TRIANGLE, corners);
  }
  return solid;
}

template <class Writer>
void write_dataset(const std::filesystem::path& path, vtkDataSet& data)
{
  write_atomically(path, [&](const std::filesystem::path& temporary) {
    vtkNew<Writer> writer;
    vtkNew<SilentObserver> silence;
    writer->AddObserver(vtkCommand::ErrorEvent, silence);
    writer->SetFileName(temporary.c_str());
    writer->SetInputData(&data);
    return writer->Write() == 1 && writer->GetErrorCode() == vtkErrorCode::NoError;
  });
}

TriangleMesh from_polydata(vtkPolyData& surface, const std::string& name)
{
  TriangleMesh mesh;
  mesh.vertices.resize(surface.GetNumberOfPoints(), 3);
  for (Eigen::Index i = 0; i < mesh.vertices.rows(); ++i) surface.GetPoint(i, mesh.vertices.row(i).data());
  mesh.triangles.resize(surface.GetNumberOfPolys(), 3);
  vtkNew<vtkIdList> corners;
  for (Eigen::Index t = 0; t < mesh.triangles.rows(); ++t) {
    surface.GetPolys()->GetCellAtId(t, corners);
    if (corners->GetNumberOfIds() != 3)
      throw InputError(
          fmt::format("{}: polygon {} has {} corners; triangulate the surface", name, t, corners->GetNumberOfIds()));
    for (int k = 0; k < 3; ++k) mesh.triangles(t, k) = static_cast<int>(corners->GetId(k));
  }
  return mesh;
}

template <int dim>
SimplexMesh<dim> from_grid(vtkUnstructuredGrid& solid, const std::string& name)
{
  SimplexMesh<dim> mesh{Vec(dim * solid.GetNumberOfPoints()), Simplices<dim>(solid.GetNumberOfCells(), dim + 1)};
  for (Eigen::Index i = 0; i < solid.GetNumberOfPoints(); ++i) {
    Vec3 X;
    solid.GetPoint(i, X.data());
    if (!X.allFinite()) throw InputError(fmt::format("{}: point {} is not finite; repair the export", name, i));
    if (dim == 2 && X.z() != 0)
      throw InputError(fmt::format("{}: point {} lies at z = {:g}; a planar body lies in z = 0", name, i, X.z()));
    mesh.positions.template segment<dim>(dim * i) = X.template head<dim>();
  }
  for (Eigen::Index e = 0; e < solid.GetNumberOfCells(); ++e) {
    if (solid.GetCellType(e) != (dim == 3 ? VTK_TETRA : VTK_TRIANGLE))
      throw InputError(fmt::format("{}: cell {} is no {}; this body consists of nothing else", name, e,
                                   dim == 3 ? "tetrahedron" : "triangle"));
    vtkNew<vtkIdList> corners;
    solid.GetCellPoints(e, corners);
    for (int k = 0; k <= dim; ++k) mesh.elements(e, k) = static_cast<int>(corners->GetId(k));
  }
  return mesh;
}

// What a reader of VTK's makes of a file, and InputError where that is nothing.
template <class Reader>
auto& read_dataset(Reader& reader, const std::filesystem::path& path, const char* what)
{
  if (!std::filesystem::is_regular_file(path))
    throw InputError(fmt::format("{}: no such file; check the path", path.string()));
  vtkNew<SilentObserver> silence;
  reader.AddObserver(vtkCommand::ErrorEvent, silence);
  reader.SetFileName(path.c_str());
  const bool can_read = reader.CanReadFile(path.c_str()) != 0;
  if (can_read) reader.Update();
  auto& data = *reader.GetOutput();
  if (!can_read || reader.GetErrorCode() != vtkErrorCode::NoError || data.GetNumberOfPoints() == 0)
    throw InputError(fmt::format("{}: is no complete {}; write it again", path.string(), what));
  return data;
}

}  // namespace

const Eigen::MatrixXd& SurfaceFields::at(const std::string& name) const
{
  std::string names;
  for (const auto* list : {&on_vertices, &on_triangles}) {
    for (const Field& field : *list) {
      if (field.name == name) return field.values;
      names += (names.empty() ? "" : ", ") + field.name;
    }
  }
  throw InputError(fmt::format("there is no field '{}'; there are: {}", name, names.empty() ? "none" : names));
}

void write_vtp(const std::filesystem::path& path, const TriangleMesh& mesh, const SurfaceFields& fields)
{
  const auto surface = to_polydata(mesh);
  add_fields(fields.on_vertices, *surface->GetPointData());
  add_fields(fields.on_triangles, *surface->GetCellData());
  write_dataset<vtkXMLPolyDataWriter>(path, *surface);
}

template <int dim>
void write_vtu(const std::filesystem::path& path, const SimplexMesh<dim>& mesh, const std::vector<Field>& on_vertices,
               const std::vector<Field>& on_elements)
{
  const auto solid = to_grid<dim>(mesh);
  add_fields(on_vertices, *solid->GetPointData());
  add_fields(on_elements, *solid->GetCellData());
  write_dataset<vtkXMLUnstructuredGridWriter>(path, *solid);
}

template void write_vtu<2>(const std::filesystem::path&, const SimplexMesh<2>&, const std::vector<Field>&,
                           const std::vector<Field>&);
template void write_vtu<3>(const std::filesystem::path&, const SimplexMesh<3>&, const std::vector<Field>&,
                           const std::vector<Field>&);

SurfaceWithFields read_vtp(const std::filesystem::path& path)
{
  vtkNew<vtkXMLPolyDataReader> reader;
  vtkPolyData& surface = read_dataset(*reader, path, "VTK surface (.vtp)");
  return {from_polydata(surface, path.string()),
          {fields_of(*surface.GetPointData()), fields_of(*surface.GetCellData())}};
}

template <int dim>
SimplexMesh<dim> read_vtu(const std::filesystem::path& path)
{
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  return from_grid<dim>(read_dataset(*reader, path, "VTK solid (.vtu)"), path.string());
}

template SimplexMesh<2> read_vtu<2>(const std::filesystem::path&);
template SimplexMesh<3> read_vtu<3>(const std::filesystem::path&);

void write_pvd(const std::filesystem::path& path, const std::vector<std::pair<double, std::filesystem::path>>& entries)
{
  const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
  std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n";
  for (const auto& [value, entry] : entries) {
    const auto name = entry.is_absolute() ? std::filesystem::proximate(entry, folder) : entry;
    text += fmt::format("<DataSet timestep=\"{}\" file=\"{}\"/>\n", value, name.generic_string());
  }
  write_text(path, text + "</Collection>\n</VTKFile>\n");
}

}  // namespace softform

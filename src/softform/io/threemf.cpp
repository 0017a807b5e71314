#include "softform/io/threemf.hpp"

#include <algorithm>
#include <vector>

#include <Model/COM/NMR_DLLInterfaces.h>
#include <fmt/format.h>

#include "softform/core/error.hpp"
#include "softform/io/atomic_write.hpp"

namespace softform {
namespace {

// An object of lib3mf's C interface, released at the end of its scope.
template <class T>
class Handle {
 public:
  Handle() = default;
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle()
  {
    if (pointer_ != nullptr) NMR::lib3mf_release(pointer_);
  }
  T** out() { return &pointer_; }
  T* get() const { return pointer_; }

 private:
  T* pointer_ = nullptr;
};

bool is_done(LIB3MFRESULT result) { return result == 0; }

bool add(const Handle<NMR::PLib3MFModel>& model, const PrintedPart& part)
{
  std::vector<NMR::MODELMESHVERTEX> vertices;
  std::vector<NMR::MODELMESHTRIANGLE> triangles;
  for (const auto& p : part.mesh.vertices.rowwise())
    vertices.push_back({{float(1e3 * p.x()), float(1e3 * p.y()), float(1e3 * p.z())}});
  for (const auto& t : part.mesh.triangles.rowwise()) triangles.push_back({{DWORD(t[0]), DWORD(t[1]), DWORD(t[2])}});
  Handle<NMR::PLib3MFModelMeshObject> object;
  Handle<NMR::PLib3MFModelBuildItem> item;
  return is_done(NMR::lib3mf_model_addmeshobject(model.get(), object.out())) &&
         (part.name.empty() || is_done(NMR::lib3mf_object_setnameutf8(object.get(), part.name.c_str()))) &&
         is_done(NMR::lib3mf_meshobject_setgeometry(object.get(), vertices.data(), DWORD(vertices.size()),
                                                    triangles.data(), DWORD(triangles.size()))) &&
         is_done(NMR::lib3mf_model_addbuilditem(model.get(), object.get(), nullptr, item.out()));
}

bool write(const std::filesystem::path& file, const std::vector<PrintedPart>& parts)
{
  Handle<NMR::PLib3MFModel> model;
  Handle<NMR::PLib3MFModelWriter> writer;
  return is_done(NMR::lib3mf_createmodel(model.out())) &&
         is_done(NMR::lib3mf_model_setunit(model.get(), NMR::MODELUNIT_MILLIMETER)) &&
         std::all_of(parts.begin(), parts.end(), [&](const PrintedPart& part) { return add(model, part); }) &&
         is_done(NMR::lib3mf_model_querywriter(model.get(), "3mf", writer.out())) &&
         is_done(NMR::lib3mf_writer_writetofileutf8(writer.get(), file.c_str()));
}

}  // namespace

void write_3mf(const std::filesystem::path& path, const std::vector<PrintedPart>& parts)
{
  write_atomically(path, [&](const std::filesystem::path& file) { return write(file, parts); });
}

void write_3mf(const std::filesystem::path& path, const TriangleMesh& mesh)
{
  write_3mf(path, std::vector<PrintedPart>{{"", mesh}});
}

}  // namespace softform

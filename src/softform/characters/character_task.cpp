#include "softform/characters/character_task.hpp"

#include "softform/materials/registry.hpp"

namespace softform {
namespace {

template <int dim>
std::shared_ptr<const SolidMaterial> material_of(const CharacterMaterials& materials, double shear_modulus)
{
  if constexpr (dim == 2) return plane_stress(make_material("neo_hookean", {{"mu", shear_modulus}}));
  return neo_hookean_solid(shear_modulus, bulk_modulus(shear_modulus, materials.poisson_ratio));
}

}  // namespace

int CharacterTask::last_stage() const
{
  const std::vector<std::string> known = stage_names(kind);
  const int last_known = kind == ActuatorKind::Strings ? 2 : 3;
  return last_known - static_cast<int>(known.size() - stages.size());
}

std::vector<std::string> stage_names(ActuatorKind kind)
{
  if (kind == ActuatorKind::Clamps) return {"uniform", "materials"};
  if (kind == ActuatorKind::Strings) return {"actuators", "places"};
  return {"actuators", "places", "materials"};
}

template <int dim>
Solid<dim> make_solid(const CharacterTask& task)
{
  const PosedMesh<dim>& body = std::get<PosedMesh<dim>>(task.body);
  const CharacterMaterials& made = task.materials;
  const auto soft = material_of<dim>(made, made.soft_shear_modulus);
  const Mixture mixture =
      made.stiff_shear_modulus > 0
          ? Mixture(soft, material_of<dim>(made, made.stiff_shear_modulus), MixturePath::Geometric, made.soft_density,
                    made.stiff_density > 0 ? made.stiff_density : made.soft_density)
          : Mixture(soft, made.soft_density);
  SolidOptions<dim> options;
  if (dim == 2) options.thickness = task.print.thickness;
  options.gravity = task.gravity.template head<dim>();
  return Solid<dim>(body.rest.elements, body.rest.positions, mixture, options);
}

template Solid<2> make_solid<2>(const CharacterTask&);
template Solid<3> make_solid<3>(const CharacterTask&);

}  // namespace softform

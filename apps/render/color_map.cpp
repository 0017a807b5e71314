#include "color_map.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>
#include <vtkCellData.h>
#include <vtkColorTransferFunction.h>
#include <vtkDataArray.h>
#include <vtkPointData.h>

#include "softform/core/error.hpp"

namespace softform::render {
namespace {

vtkSmartPointer<vtkColorTransferFunction> transfer_function(ColorMap map)
{
  auto colors = vtkSmartPointer<vtkColorTransferFunction>::New();
  if (map == ColorMap::Coolwarm) {
    colors->SetColorSpaceToDiverging();
    colors->AddRGBPoint(0, 0.230, 0.299, 0.754);
    colors->AddRGBPoint(1, 0.706, 0.016, 0.150);
    return colors;
  }
  constexpr int viridis[] = {0x440154, 0x482878, 0x3e4989, 0x31688e, 0x26828e,
                             0x1f9e89, 0x35b779, 0x6ece58, 0xb5de2b, 0xfde725};
  for (int k = 0; k < 10; ++k)
    colors->AddRGBPoint(k / 9.0, (viridis[k] >> 16) / 255.0, (viridis[k] >> 8 & 255) / 255.0,
                        (viridis[k] & 255) / 255.0);
  return colors;
}

/// Up to the next number with two significant digits.
double round_up(double value)
{
  if (!(value > 0)) return 0;
  const double step = std::pow(10.0, std::floor(std::log10(value)) - 1);
  return std::ceil(value / step - 1e-9) * step;
}

/// Where the colours start and end when the layout leaves it open: at zero, or symmetric about it, and at round
/// numbers.
std::array<double, 2> round_range(const std::array<double, 2>& range, ColorMap map)
{
  double low = -round_up(-range[0]);
  double high = round_up(range[1]);
  if (map == ColorMap::Coolwarm) {
    high = std::max(high, -low);
    low = -high;
  }
  return low < high ? std::array{low, high} : std::array{0.0, 1.0};
}

/// Colours that are told apart from each other, from 0 on, and again from the first.
vtkSmartPointer<vtkLookupTable> category_table(const std::array<double, 2>& range)
{
  // Paul Tol's muted and light schemes, in an order in which neighbours differ.
  constexpr int colors[] = {0x88ccee, 0xcc6677, 0xddcc77, 0x44aa99, 0xaa4499, 0x999933, 0x6677bb, 0xee8866, 0x44bb77,
                            0xffaabb, 0x882255, 0xbbcc33, 0x225588, 0xcc9966, 0x117733, 0xbb99dd, 0xdddddd};
  const int first = static_cast<int>(range[0]), count = static_cast<int>(range[1]) - first + 1;
  auto table = vtkSmartPointer<vtkLookupTable>::New();
  table->SetNumberOfTableValues(count);
  table->SetRange(range[0] - 0.5, range[1] + 0.5);
  for (int k = 0; k < count; ++k) {
    const int color = colors[static_cast<std::size_t>(first + k) % std::size(colors)];
    table->SetTableValue(k, (color >> 16) / 255.0, (color >> 8 & 255) / 255.0, (color & 255) / 255.0, 1);
  }
  return table;
}

}  // namespace

vtkSmartPointer<vtkLookupTable> lookup_table(ColorMap map, const std::array<double, 2>& range)
{
  if (map == ColorMap::Categories) return category_table(range);
  constexpr int count = 256;
  const auto colors = transfer_function(map);
  auto table = vtkSmartPointer<vtkLookupTable>::New();
  table->SetNumberOfTableValues(count);
  table->SetRange(range[0], range[1]);
  for (int k = 0; k < count; ++k) {
    Color rgb;
    colors->GetColor(k / (count - 1.0), rgb.data());
    table->SetTableValue(k, rgb[0], rgb[1], rgb[2], 1);
  }
  return table;
}

std::array<double, 2> activate_field(vtkPolyData& surface, const Scalar& scalar, const std::filesystem::path& file)
{
  vtkDataSetAttributes* data = surface.GetPointData();
  if (!data->HasArray(scalar.field.c_str())) data = surface.GetCellData();
  vtkDataArray* field = data->GetArray(scalar.field.c_str());
  if (!field || field->GetNumberOfComponents() != 1)
    throw InputError(
        fmt::format("{}: has no scalar field '{}'; see its point and cell data", file.string(), scalar.field));
  for (vtkIdType i = 0; i < field->GetNumberOfTuples(); ++i) field->SetTuple1(i, scalar.factor * field->GetTuple1(i));
  field->Modified();
  data->SetActiveScalars(scalar.field.c_str());
  std::array<double, 2> range;
  field->GetRange(range.data());
  return scalar.range.value_or(scalar.map == ColorMap::Categories ? range : round_range(range, scalar.map));
}

}  // namespace softform::render

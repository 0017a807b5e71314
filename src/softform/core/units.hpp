#pragma once

#include <string>

namespace softform {

/// "0.3mm", "14.6 cm", "1m" -> metres. Throws InputError for a bare number or an unknown unit.
double parse_length(const std::string& text);

/// "1kPa", "0.16 MPa", "30 mbar" -> pascals. Throws InputError for a bare number or an unknown unit.
double parse_pressure(const std::string& text);

/// "1070kg/m^3", "1.07 g/cm^3" -> kilograms a cubic metre. Throws InputError for a bare number or an unknown unit.
double parse_density(const std::string& text);

/// "9.81m/s^2" -> metres a second squared. Throws InputError for a bare number or an unknown unit.
double parse_acceleration(const std::string& text);

}  // namespace softform

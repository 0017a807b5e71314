#pragma once

#include <string>

namespace softform {

/// "0.3mm", "14.6 cm", "1m" -> metres. Throws InputError for a bare number or an unknown unit.
double parse_length(const std::string& text);

/// "1kPa", "0.16 MPa", "30 mbar" -> pascals. Throws InputError for a bare number or an unknown unit.
double parse_pressure(const std::string& text);

}  // namespace softform

#pragma once

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "softform/core/error.hpp"

namespace softform::test {

/// Expects that `body` throws InputError and that its message holds every one of the texts.
template <class Body>
void expect_input_error(const Body& body, const std::vector<std::string>& texts)
{
  try {
    body();
    FAIL() << "no InputError";
  } catch (const InputError& error) {
    for (const std::string& text : texts)
      EXPECT_NE(std::string(error.what()).find(text), std::string::npos)
          << "'" << text << "' is missing in: " << error.what();
  }
}

}  // namespace softform::test

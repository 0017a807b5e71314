# Compiler flags of our own targets: warnings are never exported to users of the library.
add_library(softform_warnings INTERFACE)
target_compile_options(softform_warnings INTERFACE -Wall -Wextra -Wconversion -Wshadow)
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # False alarms out of gcc 12's own AVX-512 headers (gcc bug 105593).
  target_compile_options(softform_warnings INTERFACE -Wno-maybe-uninitialized -Wno-array-bounds)
endif()

if(SOFTFORM_NATIVE)
  add_compile_options(-march=native)
endif()
if(SOFTFORM_SANITIZE)
  add_compile_options(-fsanitize=${SOFTFORM_SANITIZE} -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${SOFTFORM_SANITIZE})
endif()

find_program(CCACHE ccache)
if(CCACHE)
  set(CMAKE_C_COMPILER_LAUNCHER ${CCACHE})
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE})
endif()

# The paths of the source tree's data, for programs run from a checkout.
set(SOFTFORM_SOURCE_DATA_DIR ${CMAKE_SOURCE_DIR}/datasets)

# cmake --install, and an exported target for find_package(softform).

#include "softform/characters/pin_pipeline.hpp"

// The one place where tinygltf's code is compiled.
#define TINYGLTF_IMPLEMENTATION
#include "scene/tinygltf.hpp"

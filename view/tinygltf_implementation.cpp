// Compiles the implementation of tinygltf, a header-only library.
#define TINYGLTF_IMPLEMENTATION
#include <tiny_gltf.h>

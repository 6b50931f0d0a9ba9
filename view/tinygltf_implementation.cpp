// The body of tinygltf, which is one header.
#define TINYGLTF_IMPLEMENTATION
#include <tiny_gltf.h>

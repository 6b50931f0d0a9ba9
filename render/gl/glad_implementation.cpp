// The one translation unit that holds the bodies of the header-only loader.
#define GLAD_GL_IMPLEMENTATION
#include <glad/gl.h>

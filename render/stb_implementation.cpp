// The one translation unit that holds the bodies of stb_truetype, included as a system header
// because its warnings do not concern this project.
#define STB_TRUETYPE_IMPLEMENTATION
#include <stb/stb_truetype.h>

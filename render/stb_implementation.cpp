// The one translation unit that holds the bodies of stb_truetype. A system header: its warnings are
// not ours.
#define STB_TRUETYPE_IMPLEMENTATION
#include <stb/stb_truetype.h>

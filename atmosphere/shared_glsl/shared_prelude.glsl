// Opens shared sources in GLSL; the C++ counterpart is shared_begin.h.
#define SHARED
#define SHARED_BITS
#define SHARED_CONSTANT const
#define Number float
#define Length float
#define Bits uint
#define select(condition, yes, no) ((condition) ? (yes) : (no))

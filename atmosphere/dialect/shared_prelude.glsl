// Opens shared texts for GLSL; the C++ twin is shared_begin.h.
#define SHARED
#define Number float
#define Length float
#define select(condition, yes, no) ((condition) ? (yes) : (no))

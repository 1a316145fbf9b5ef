// No shifting law.
#define SHIFTING 0
#define SHIFT_TENSILE 0

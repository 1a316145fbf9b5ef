// No shifting law.
#define SHIFTING 0

// No eddies below the spacing.
#define EDDIES 0

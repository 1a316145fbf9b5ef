// No density diffusion.
#define DENSITY_DIFFUSION 0
#define DIVERGENCE_RENORMALISED 1

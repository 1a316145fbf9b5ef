// Morris' sum for the physical viscosity, isotropic (MLS paper, eq 14); the artificial one acts along the line of centres all the same.
#define VISCOSITY_SHEARS 1
#define WALL_DRAG R(1.0)

// What is multiplied by u_j − u_i and summed.
INLINE tile pair_shear(__constant const parameters_t* p, const pair_t* pair) { return R(2.0) * p->viscosity * pair->slope_volume; }

// Of p_j − p_i: the fit's own derivative, exact for quadratics. Nothing in it knows of a free surface.
#define ADJOINT_PRESSURE 0

INLINE tile pair_pressure(tile own, tile near) { return near - own; }

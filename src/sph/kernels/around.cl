// What is found about each particle's free surface and evenness, in an array of its own: AROUND_….

// λ below which a particle is on the surface, and above which it is inside; between them the cone tells.
#define EIGENVALUE_OF_SURFACE R(0.2)
#define EIGENVALUE_INSIDE R(0.75)

// Of a particle whose shift is wanted.
typedef struct {
  vector_t concentration, velocity;
  real approach;  // m/s
  real depth;     // its distance from the nearest particle of the surface, of the support; 1 beyond it
  real step;      // Δt
} shifted_t;

INLINE vector_t times(real factor, vector_t v) { return make_vector(factor * v.x, factor * v.y, factor * v.z); }

// No longer than `most`.
INLINE vector_t limited(vector_t v, real most) {
  const real size = sqrt(dot3(v, v));
  return size > most ? times(most / size, v) : v;
}

// The members of the parameter block that every kernel reads: included inside a struct by the device code and by the host alike, so that both have
// one layout. Lengths in m, relative to the grid's origin; 2-D quantities are per metre of width.
real spacing;             // Δx
real smoothing_length;    // h
real inverse_smoothing;   // 1/h
real support;             // R = 2h
real support_squared;     // R²
real inverse_support;     // 1/R
real kernel_scale;        // α of W = α (1−q/2)⁴ (1+2q)
real slope_scale;         // 5α/h² of F = 5α/h² (1−q/2)³
real inverse_cell;        // 1/side of a walls' cell; the side is R
real density;             // ρ₀
real bulk_modulus;        // ρ₀ c₀²
real sound_speed;         // c₀
real gravity_x;
real gravity_y;
real gravity_z;
real hydrostatic_x;       // g/c₀²: the gradient of the hydrostatic compression, linearised
real hydrostatic_y;
real hydrostatic_z;
real viscosity;           // μ, of the wall's shear
real pair_viscosity;      // α h c₀ ρ₀ + 2(d+2) μ: artificial and Monaghan–Gingold viscosity have one form
real density_diffusion;   // δ h c₀
real steady_rate;         // 1/s, by which the steady part of the diffusion follows it
real steady_limit;        // 1/s, of that part
real guard_distance;      // nearer to a wall, a particle loses its approaching normal velocity
real courant;             // of h/(c₀ + |u|)
real viscous_time;        // bound on Δt from viscosity, s
real greatest_speed;      // the watchdog's: c₀/2
real lower_x;             // the watchdog's box: outside it, a particle is lost
real lower_y;
real lower_z;
real upper_x;
real upper_y;
real upper_z;
real period_x;            // of a periodic tank, else 0
real period_y;
real period_z;
real rim;                 // top_way times the rim's coordinate along top_axis: above it, the splash guard keeps particles over the tank
int cells_x;              // the walls' cells, a border of one empty cell included in each direction
int cells_y;
int cells_z;
int cells;                // their product
real row_side;            // of the particles' rows along x, across
real inverse_row;         // 1 / that
real inverse_slot;        // 1 / length of a slot of a row
int rows_y;               // rows, and slots of each, a border of one empty one included in each direction
int rows_z;
int slots_x;
int top_axis;             // of the tank's top: 0, 1, 2; and on which side it is
int top_way;              // 1: of the greatest coordinates, −1: of the least
int images;               // of the tank: periodic shifts and ghosts
real damping;             // 1/s, of the velocities: only before the start
real repulsion;           // of ghosts, (m/s)²: short-range force by the wall

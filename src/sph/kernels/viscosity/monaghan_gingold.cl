// Monaghan and Gingold's sum for the physical viscosity: along the line of centres, as the artificial one.
#define VISCOSITY_SHEARS 0
// of a wall's drag, so that it balances in a uniform shear what the particles on the other side exert
#define WALL_DRAG ((DIMENSIONS + R(2.0)) / (DIMENSIONS + R(1.0)))

#include "pump.h"

void pump_reset(pump_state *s)
{
    s->z[0] = 0.0;
    s->z[1] = 0.0;
}

void pump_step(pump_state *s, const double y[1], const double r[1], double u[1])
{
    double next_z[2];
    double e[1] = {0.0};
    u[0] = -0.679 * y[0]
        + -0.198 * s->z[0]
        + 0.75 * s->z[1];
    e[0] = u[0];
    u[0] = u[0] < -0.3 ? -0.3 : u[0] > 0.3 ? 0.3 : u[0];
    e[0] = u[0] - e[0];
    next_z[0] = 1.0 * y[0]
        + 1.0 * s->z[0]
        + -1.0 * r[0]
        + -2.76 * e[0];
    next_z[1] = 1.21 * y[0]
        + 0.359 * s->z[0]
        + -1.37 * s->z[1]
        + -1.67 * e[0];
    s->z[0] = next_z[0];
    s->z[1] = next_z[1];
}

#include "valve.h"

void valve_reset(valve_state *s)
{
    s->z[0] = 0.0;
    s->z[1] = 0.0;
}

void valve_step(valve_state *s, const double y[1], const double r[1], double u[1])
{
    double next_z[2];
    double e[1] = {0.0};
    u[0] = -0.811 * y[0]
        + -0.247 * s->z[0]
        + 1.04 * s->z[1];
    e[0] = u[0];
    u[0] = u[0] < -0.3 ? -0.3 : u[0] > 0.3 ? 0.3 : u[0];
    e[0] = u[0] - e[0];
    next_z[0] = 1.0 * y[0]
        + 1.0 * s->z[0]
        + -1.0 * r[0]
        + -2.43 * e[0];
    next_z[1] = 0.971 * y[0]
        + 0.3 * s->z[0]
        + -1.27 * s->z[1]
        + -1.16 * e[0];
    s->z[0] = next_z[0];
    s->z[1] = next_z[1];
}

/*
 * Agent 'pump' of a distributed controller in discrete time.
 * Made for the plant of digest 681984dfb34eb0a48ab5023133c9fc678b4cedef7741f48c4933e1b70240ea93.
 * 7 of its 11 numbers are rounded to the nearest double.
 * In each sampling period: measure y, run the step, set u.
 * Inputs are cut off at their limits, and its states are corrected by what was cut off.
 * These limits are those of the controller, rounded to the nearest doubles.
 * All states start at 0.
 */

#ifndef PUMP_H
#define PUMP_H

typedef struct {
    double z[2];
} pump_state;

void pump_reset(pump_state *s);

void pump_step(pump_state *s, const double y[1], const double r[1], double u[1]);

#endif

/* Runs the controller in code/ on a recorded loop, and compares every input that it computes.
 *
 * The recording is what `mcexact simulate … -o recorded.csv` writes: in each line the outputs that
 * were measured, the set-points, and the inputs that the code computed from them.  In a plant the
 * three marked lines are replaced by sensors, a clock and actuators.
 */

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "pump.h"
#include "valve.h"

enum { COLUMNS = 64, LENGTH = 4096 };

static char header[LENGTH];
static char *names[COLUMNS];
static double values[COLUMNS];
static int columns;

/* The number in a column of the current line. */
static double recorded(const char *name)
{
    int k;
    for (k = 0; k < columns; k++)
        if (strcmp(names[k], name) == 0)
            return values[k];
    fprintf(stderr, "there is no column '%s'\n", name);
    exit(2);
}

/* Compares the bits of an input with the recorded ones. */
static int differs(double u, const char *name)
{
    const double wanted = recorded(name);
    return memcmp(&u, &wanted, sizeof u) != 0;
}

static int read_line(FILE *file)
{
    static char line[LENGTH];
    char *rest = line;
    int k;
    if (fgets(line, LENGTH, file) == NULL)
        return 0;
    for (k = 0; k < columns; k++) {
        values[k] = strtod(rest, &rest);
        rest += *rest == ',';
    }
    return 1;
}

static void read_header(FILE *file)
{
    char *name;
    if (fgets(header, LENGTH, file) == NULL)
        exit(2);
    for (name = strtok(header, ",\r\n"); name != NULL && columns < COLUMNS; name = strtok(NULL, ",\r\n"))
        names[columns++] = name;
}

int main(int count, char **arguments)
{
    FILE *file = count == 2 ? fopen(arguments[1], "r") : NULL;
    pump_state pump;
    valve_state valve;
    int samples = 0, wrong = 0;
    if (file == NULL) {
        fprintf(stderr, "usage: play recorded.csv\n");
        return 2;
    }
    read_header(file);
    pump_reset(&pump);
    valve_reset(&valve);
    while (read_line(file)) { /* a timer, every 5 units of time */
        double y_pump[1], y_valve[1], r_pump[1], r_valve[1], u_pump[1], u_valve[1];
        y_pump[0] = recorded("measured y pump"); /* the sensors */
        y_valve[0] = recorded("measured y valve");
        r_pump[0] = recorded("r pump");
        r_valve[0] = recorded("r valve");
        pump_step(&pump, y_pump, r_pump, u_pump);
        valve_step(&valve, y_valve, r_valve, u_valve);
        wrong += differs(u_pump[0], "computed u pump"); /* the actuators */
        wrong += differs(u_valve[0], "computed u valve");
        samples++;
    }
    fclose(file);
    printf("%d samples, %d inputs differ from the recorded ones\n", samples, wrong);
    return wrong != 0 || samples == 0;
}

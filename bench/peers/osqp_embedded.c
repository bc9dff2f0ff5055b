/* OSQP's generated code for one program, whose vectors change: the workspace is static data, and nothing is allocated. */
#include <time.h>

#include "osqp.h"
#include "workspace.h"

/* Solves for a gradient and bounds into z of so many unknowns, counts iterations and tells the time, ns. Returns 0 when the solver says
 * that it has solved it. */
int embedded_solve(const double *gradient, const double *lower, const double *upper, int warm, int unknowns, double *z,
                   int *iterations, double *taken_ns) {
    struct timespec begin, end;
    clock_gettime(CLOCK_MONOTONIC, &begin);
    if (!warm) osqp_cold_start(&solver);
    osqp_update_data_vec(&solver, gradient, lower, upper);
    osqp_solve(&solver);
    clock_gettime(CLOCK_MONOTONIC, &end);
    *taken_ns = (end.tv_sec - begin.tv_sec) * 1e9 + (end.tv_nsec - begin.tv_nsec);
    *iterations = solver.info->iter;
    for (int i = 0; i < unknowns; i++) z[i] = solver.solution->x[i];
    return solver.info->status_val == OSQP_SOLVED ? 0 : 1;
}

/* OSQP's generated code in single precision, sample by sample along a flight. */
#include "osqp.h"
#include "peer.h"
#include "samples.h"
#include "workspace.h"

static unsigned long long counts[SAMPLES];

int main(void)
{
    int most_iterations = 0, failures = 0;
    for (int sample = 0; sample < SAMPLES; sample++) {
        unsigned long long before = instructions();
        osqp_update_data_vec(&solver, (OSQPFloat *)gradient[sample], 0, (OSQPFloat *)upper[sample]);
        osqp_solve(&solver);
        counts[sample] = instructions() - before;
        if (solver.info->iter > most_iterations) most_iterations = solver.info->iter;
        failures += solver.info->status_val != OSQP_SOLVED;
    }
    report(counts, SAMPLES, most_iterations, failures);
    return 0;
}

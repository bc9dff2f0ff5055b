// TinyMPC's generated code in single precision, sample by sample along a flight.
#include <tinympc/tiny_api.hpp>
#include <tinympc/tiny_data.hpp>

#include "peer.h"
#include "samples.h"

static unsigned long long counts[SAMPLES];

int main()
{
    int most_iterations = 0, failures = 0;
    for (int sample = 0; sample < SAMPLES; sample++) {
        tinyVector state(STATES);
        for (int i = 0; i < STATES; i++) state(i) = start[sample][i];
        unsigned long long before = instructions();
        tiny_set_x0(&tiny_solver, state);
        tiny_solve(&tiny_solver);
        counts[sample] = instructions() - before;
        if (tiny_solver.solution->iter > most_iterations) most_iterations = tiny_solver.solution->iter;
        failures += !tiny_solver.solution->solved;
    }
    report(counts, SAMPLES, most_iterations, failures);
    return 0;
}

/* What a peer on the emulated Cortex-M4F needs: instructions counted, and a line of figures. */
#ifndef PEER_H
#define PEER_H

#ifdef __cplusplus
extern "C" {
#endif

/* Instructions since the start. */
unsigned long long instructions(void);

/* Prints counts of steps, sorted by it, with the most iterations and how many steps found no solution, as JSON. */
void report(unsigned long long *counts, int steps, int most_iterations, int failures);

#ifdef __cplusplus
}
#endif

#endif

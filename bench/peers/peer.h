/* What a library with a peer offers: a solver of  min 1/2 z'z + f'z  under  G z <= b.
 *
 * All that does not depend on f and b is done by peer_new, as a controller does it at design time. b may have elements of 1e20 and more:
 * no bound. */
#ifndef PEER_H
#define PEER_H

#include <stddef.h>

/* Name and version, for the report. */
const char *peer_name(void);

/* G has `rows` rows of `unknowns` numbers, row by row; it is copied. NULL if the solver refuses the program. */
void *peer_new(int unknowns, int rows, const double *left);

/* Solves for f and b into z and counts iterations. `warm` is not 0 when it may begin where the last solution ended.
 * Returns 0 when the solver says that it has solved it. */
int peer_solve(void *peer, const double *gradient, const double *upper, int warm, double *z, int *iterations);

/* Bytes that the solver needs for the program; 0 when it does not tell. */
size_t peer_memory(const void *peer);

void peer_free(void *peer);

#endif

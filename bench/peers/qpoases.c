/* qpOASES (its translation into C): a parametric active-set method. Its options are those for model predictive control. */
#include <stdlib.h>
#include <string.h>

#include <qpOASES_e/QProblem.h>

#include "peer.h"

typedef struct {
    QProblem *problem;
    void *memory;
    size_t size;
    int unknowns, rows, begun;
    double *hessian, *left;
} Peer;

const char *peer_name(void) { return "qpOASES_e 3.1"; }

void *peer_new(int n, int m, const double *left) {
    Peer *peer = calloc(1, sizeof *peer);
    peer->unknowns = n;
    peer->rows = m;
    peer->size = QProblem_calculateMemorySize(n, m);
    peer->memory = aligned_alloc(64, (peer->size + 127) / 64 * 64);
    QProblem_assignMemory(n, m, &peer->problem, peer->memory);
    peer->hessian = calloc((size_t)n * n, sizeof(double));
    for (int i = 0; i < n; i++) peer->hessian[i * n + i] = 1.0;
    peer->left = malloc(sizeof(double) * n * m);
    memcpy(peer->left, left, sizeof(double) * n * m);
    return peer;
}

int peer_solve(void *opaque, const double *gradient, const double *upper, int warm, double *z, int *iterations) {
    Peer *peer = opaque;
    int changes = 10000;
    returnValue result;
    if (warm && peer->begun) {
        result = QProblem_hotstart(peer->problem, gradient, NULL, NULL, NULL, upper, &changes, NULL);
    } else {
        Options options;
        QProblemCON(peer->problem, peer->unknowns, peer->rows, HST_IDENTITY);
        Options_setToMPC(&options);
        options.printLevel = PL_NONE;
        QProblem_setOptions(peer->problem, options);
        result = QProblem_init(peer->problem, peer->hessian, gradient, peer->left, NULL, NULL, NULL, upper, &changes, NULL);
    }
    *iterations = changes;
    peer->begun = result == SUCCESSFUL_RETURN;
    if (!peer->begun) return 1;
    return QProblem_getPrimalSolution(peer->problem, z) == SUCCESSFUL_RETURN ? 0 : 1;
}

size_t peer_memory(const void *opaque) { return ((const Peer *)opaque)->size; }

void peer_free(void *opaque) {
    Peer *peer = opaque;
    free(peer->memory);
    free(peer->hessian);
    free(peer->left);
    free(peer);
}

/* DAQP: a dual active-set method. It sees that H is diagonal; all that G and H need is done once. */
#include <stdlib.h>
#include <string.h>

#include "api.h"
#include "peer.h"
#include "utils.h"

typedef struct {
    DAQPProblem problem;
    DAQPWorkspace work;
    size_t memory;
    double *left, *hessian, *gradient, *upper, *lower;
    int *sense;
} Peer;

const char *peer_name(void) { return "DAQP 0.11.0"; }

void *peer_new(int n, int m, const double *left) {
    Peer *peer = calloc(1, sizeof *peer);
    peer->left = malloc(sizeof(double) * n * m);
    memcpy(peer->left, left, sizeof(double) * n * m);
    peer->hessian = calloc((size_t)n * n, sizeof(double));
    for (int i = 0; i < n; i++) peer->hessian[i * n + i] = 1.0;
    peer->gradient = calloc(n, sizeof(double));
    peer->upper = calloc(m, sizeof(double));
    peer->lower = malloc(sizeof(double) * m);
    peer->sense = calloc(m, sizeof(int));
    for (int i = 0; i < m; i++) {
        peer->upper[i] = 1.0;
        peer->lower[i] = -1e30;
    }
    DAQPProblem problem = {0};
    problem.n = n;
    problem.m = m;
    problem.H = peer->hessian;
    problem.f = peer->gradient;
    problem.A = peer->left;
    problem.bupper = peer->upper;
    problem.blower = peer->lower;
    problem.sense = peer->sense;
    peer->problem = problem;
    double setup_s;
    if (setup_daqp(&peer->problem, &peer->work, &setup_s) < 0) {
        free(peer);
        return NULL;
    }
    /* M, the bounds, the scaling, L, and vectors of the unknowns. */
    peer->memory = sizeof *peer + sizeof(double) * ((size_t)n * m + 4 * (size_t)m + (size_t)(n + 2) * (n + 3) / 2 + 12 * (size_t)n)
                   + sizeof(int) * 2 * (size_t)m;
    return peer;
}

int peer_solve(void *opaque, const double *gradient, const double *upper, int warm, double *z, int *iterations) {
    Peer *peer = opaque;
    const int n = peer->problem.n, m = peer->problem.m;
    memcpy(peer->gradient, gradient, sizeof(double) * n);
    memcpy(peer->upper, upper, sizeof(double) * m);
    if (!warm) daqp_deactivate_constraints(&peer->work);
    if (!warm) reset_daqp_workspace(&peer->work);
    if (daqp_update_ldp(DAQP_UPDATE_v + DAQP_UPDATE_d, &peer->work, &peer->problem) < 0) return 1;
    DAQPResult result = {0};
    result.x = z;
    daqp_solve(&result, &peer->work);
    *iterations = result.iter;
    return result.exitflag > 0 ? 0 : 1;
}

size_t peer_memory(const void *opaque) { return ((const Peer *)opaque)->memory; }

void peer_free(void *opaque) {
    Peer *peer = opaque;
    free_daqp_workspace(&peer->work);
    free_daqp_ldp(&peer->work);
    free(peer->left);
    free(peer->hessian);
    free(peer->gradient);
    free(peer->upper);
    free(peer->lower);
    free(peer->sense);
    free(peer);
}

/* HPIPM: an interior-point method on BLASFEO, in its mode "speed". Lower bounds, which there are none of, are masked. */
#include <stdlib.h>
#include <string.h>

#include <blasfeo_common.h>
#include <hpipm_common.h>
#include <hpipm_d_dense_qp_dim.h>
#include <hpipm_d_dense_qp.h>
#include <hpipm_d_dense_qp_sol.h>
#include <hpipm_d_dense_qp_ipm.h>

#include "peer.h"

/* Larger bounds are none. */
#define UNBOUNDED 1e10

typedef struct {
    struct d_dense_qp_dim dim;
    struct d_dense_qp qp;
    struct d_dense_qp_sol sol;
    struct d_dense_qp_ipm_arg arg;
    struct d_dense_qp_ipm_ws ws;
    void *memory[5];
    size_t size;
    int unknowns, rows;
    double *upper;
} Peer;

static void *part(Peer *peer, int at, size_t size) {
    peer->size += size;
    peer->memory[at] = aligned_alloc(64, (size + 127) / 64 * 64);
    memset(peer->memory[at], 0, size);
    return peer->memory[at];
}

const char *peer_name(void) { return "HPIPM 0.2 (dense)"; }

void *peer_new(int n, int m, const double *left) {
    Peer *peer = calloc(1, sizeof *peer);
    peer->unknowns = n;
    peer->rows = m;
    d_dense_qp_dim_create(&peer->dim, part(peer, 0, d_dense_qp_dim_memsize()));
    d_dense_qp_dim_set_all(n, 0, 0, m, 0, 0, &peer->dim);
    d_dense_qp_create(&peer->dim, &peer->qp, part(peer, 1, d_dense_qp_memsize(&peer->dim)));
    d_dense_qp_sol_create(&peer->dim, &peer->sol, part(peer, 2, d_dense_qp_sol_memsize(&peer->dim)));
    d_dense_qp_ipm_arg_create(&peer->dim, &peer->arg, part(peer, 3, d_dense_qp_ipm_arg_memsize(&peer->dim)));
    d_dense_qp_ipm_arg_set_default(SPEED, &peer->arg);
    int most = 100;
    d_dense_qp_ipm_arg_set_iter_max(&most, &peer->arg);
    d_dense_qp_ipm_ws_create(&peer->dim, &peer->arg, &peer->ws,
                             part(peer, 4, d_dense_qp_ipm_ws_memsize(&peer->dim, &peer->arg)));
    double *hessian = calloc((size_t)n * n, sizeof(double));
    double *columns = malloc(sizeof(double) * n * m);
    double *none = calloc(m, sizeof(double));
    for (int i = 0; i < n; i++) hessian[i * n + i] = 1.0;
    for (int i = 0; i < m; i++)
        for (int j = 0; j < n; j++) columns[j * m + i] = left[i * n + j];
    d_dense_qp_set_H(hessian, &peer->qp);
    d_dense_qp_set_C(columns, &peer->qp);
    for (int i = 0; i < m; i++) none[i] = -UNBOUNDED;
    d_dense_qp_set_lg(none, &peer->qp);
    memset(none, 0, sizeof(double) * m);
    d_dense_qp_set_lg_mask(none, &peer->qp);
    free(hessian);
    free(columns);
    free(none);
    peer->upper = malloc(sizeof(double) * m);
    return peer;
}

int peer_solve(void *opaque, const double *gradient, const double *upper, int warm, double *z, int *iterations) {
    Peer *peer = opaque;
    int status, start = warm ? 1 : 0;
    for (int i = 0; i < peer->rows; i++) peer->upper[i] = upper[i] < UNBOUNDED ? upper[i] : UNBOUNDED;
    d_dense_qp_set_g((double *)gradient, &peer->qp);
    d_dense_qp_set_ug(peer->upper, &peer->qp);
    d_dense_qp_ipm_arg_set_warm_start(&start, &peer->arg);
    d_dense_qp_ipm_solve(&peer->qp, &peer->sol, &peer->arg, &peer->ws);
    d_dense_qp_ipm_get_status(&peer->ws, &status);
    d_dense_qp_ipm_get_iter(&peer->ws, iterations);
    d_dense_qp_sol_get_v(&peer->sol, z);
    return status;
}

size_t peer_memory(const void *opaque) { return ((const Peer *)opaque)->size; }

void peer_free(void *opaque) {
    Peer *peer = opaque;
    for (int i = 0; i < 5; i++) free(peer->memory[i]);
    free(peer->upper);
    free(peer);
}

/* HPIPM on a program in stages: an interior-point method on Riccati's recursion, in its mode "speed". The first state is known, and none of
 * the unknowns. Matrices are given column by column. */
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <blasfeo_common.h>
#include <hpipm_common.h>
#include <hpipm_d_ocp_qp_dim.h>
#include <hpipm_d_ocp_qp.h>
#include <hpipm_d_ocp_qp_sol.h>
#include <hpipm_d_ocp_qp_ipm.h>

typedef struct {
    struct d_ocp_qp_dim dim;
    struct d_ocp_qp qp;
    struct d_ocp_qp_sol sol;
    struct d_ocp_qp_ipm_arg arg;
    struct d_ocp_qp_ipm_ws ws;
    void *memory[5];
} Ocp;

/* A stage: x' = A x + B u costs (x'Qx + u'Ru)/2 + u'Sx under C x + D u <= upper. */
typedef struct {
    int rows;
    double *a, *b, *q, *s, *r, *c, *d, *upper;
} Stage;

static void *part(Ocp *ocp, int at, size_t size) {
    ocp->memory[at] = aligned_alloc(64, (size + 127) / 64 * 64);
    memset(ocp->memory[at], 0, size);
    return ocp->memory[at];
}

static void dimensions(Ocp *ocp, int stages, int states, int inputs, const Stage *stage) {
    int *sizes = calloc(8 * (stages + 1), sizeof *sizes);
    int *nx = sizes, *nu = nx + stages + 1, *ng = nu + stages + 1, *none = ng + stages + 1;
    for (int k = 0; k <= stages; k++) {
        nx[k] = k == 0 ? 0 : states;
        nu[k] = k == stages ? 0 : inputs;
        ng[k] = k == stages ? 0 : stage[k].rows;
    }
    d_ocp_qp_dim_create(stages, &ocp->dim, part(ocp, 0, d_ocp_qp_dim_memsize(stages)));
    d_ocp_qp_dim_set_all(nx, nu, none, none, ng, none, none, none, &ocp->dim);
    free(sizes);
}

void *ocp_new(int stages, int states, int inputs, const Stage *stage) {
    Ocp *ocp = calloc(1, sizeof *ocp);
    dimensions(ocp, stages, states, inputs, stage);
    d_ocp_qp_create(&ocp->dim, &ocp->qp, part(ocp, 1, d_ocp_qp_memsize(&ocp->dim)));
    d_ocp_qp_sol_create(&ocp->dim, &ocp->sol, part(ocp, 2, d_ocp_qp_sol_memsize(&ocp->dim)));
    d_ocp_qp_ipm_arg_create(&ocp->dim, &ocp->arg, part(ocp, 3, d_ocp_qp_ipm_arg_memsize(&ocp->dim)));
    d_ocp_qp_ipm_arg_set_default(SPEED, &ocp->arg);
    int most = 100;
    d_ocp_qp_ipm_arg_set_iter_max(&most, &ocp->arg);
    d_ocp_qp_ipm_ws_create(&ocp->dim, &ocp->arg, &ocp->ws, part(ocp, 4, d_ocp_qp_ipm_ws_memsize(&ocp->dim, &ocp->arg)));
    d_ocp_qp_set_all_zero(&ocp->qp);
    for (int k = 0; k < stages; k++) {
        const Stage *at = &stage[k];
        double *none = calloc(at->rows + 1, sizeof *none);
        if (k > 0) {
            d_ocp_qp_set_A(k, at->a, &ocp->qp);
            d_ocp_qp_set_Q(k, at->q, &ocp->qp);
            d_ocp_qp_set_S(k, at->s, &ocp->qp);
            d_ocp_qp_set_C(k, at->c, &ocp->qp);
        }
        d_ocp_qp_set_B(k, at->b, &ocp->qp);
        d_ocp_qp_set_R(k, at->r, &ocp->qp);
        d_ocp_qp_set_D(k, at->d, &ocp->qp);
        d_ocp_qp_set_ug(k, at->upper, &ocp->qp);
        d_ocp_qp_set_lg_mask(k, none, &ocp->qp);
        free(none);
    }
    return ocp;
}

/* Solves for what the first state adds to the first stage: A x to its motion, S x to its gradient, and -C x to its bounds. Tells the first
 * input, the iterations and the time, ns. Returns 0 when the solver says that it has solved it. */
int ocp_solve(void *opaque, double *motion, double *gradient, double *upper, int warm, double *input, int *iterations,
              double *taken_ns) {
    Ocp *ocp = opaque;
    struct timespec begin, end;
    int status;
    clock_gettime(CLOCK_MONOTONIC, &begin);
    d_ocp_qp_set_b(0, motion, &ocp->qp);
    d_ocp_qp_set_r(0, gradient, &ocp->qp);
    d_ocp_qp_set_ug(0, upper, &ocp->qp);
    d_ocp_qp_ipm_arg_set_warm_start(&warm, &ocp->arg);
    d_ocp_qp_ipm_solve(&ocp->qp, &ocp->sol, &ocp->arg, &ocp->ws);
    d_ocp_qp_sol_get_u(0, &ocp->sol, input);
    clock_gettime(CLOCK_MONOTONIC, &end);
    *taken_ns = (end.tv_sec - begin.tv_sec) * 1e9 + (end.tv_nsec - begin.tv_nsec);
    d_ocp_qp_ipm_get_status(&ocp->ws, &status);
    d_ocp_qp_ipm_get_iter(&ocp->ws, iterations);
    return status;
}

void ocp_free(void *opaque) {
    Ocp *ocp = opaque;
    for (int i = 0; i < 5; i++) free(ocp->memory[i]);
    free(ocp);
}

"""Solvers of the Python registry on the shipped programs and on full horizons. Times are the solvers' own; where one reports none, the
wall clock around its call. Each takes what does not change between samples at its set-up, as a controller would."""

import importlib
import time

import numpy as np
from scipy import sparse

#: Of all solvers with tolerances.
TOLERANCE = 1e-6


class Osqp:
    name = "OSQP"

    def __init__(self, hessian, left, lower, upper, gradient):
        self.solver = importlib.import_module("osqp").OSQP()
        self.solver.setup(hessian, gradient, left, lower, upper, verbose=False, eps_abs=TOLERANCE, eps_rel=TOLERANCE, max_iter=4000,
                          polishing=False)

    def solve(self, gradient, lower, upper, warm):
        if not warm:
            self.solver.warm_start(x=np.zeros(len(gradient)), y=np.zeros(len(upper)))
        self.solver.update(q=gradient, l=lower, u=upper)
        result = self.solver.solve()
        return result.x, (result.info.update_time + result.info.solve_time) * 1e9, result.info.status_val == 1, result.info.iter


class Piqp:
    name = "PIQP"

    def __init__(self, hessian, left, lower, upper, gradient):
        piqp = importlib.import_module("piqp")
        self.ok = piqp.PIQP_SOLVED
        equal = np.flatnonzero(lower == upper)
        self.equal, self.rest = equal, np.setdiff1d(np.arange(len(upper)), equal)
        dense = len(equal) == 0
        self.solver = piqp.DenseSolver() if dense else piqp.SparseSolver()
        self.solver.settings.eps_abs = self.solver.settings.eps_rel = TOLERANCE
        self.solver.settings.compute_timings = True
        form = (lambda matrix: matrix.toarray()) if dense else sparse.csc_matrix
        rows = sparse.csr_matrix(left)
        self.empty = form(sparse.csc_matrix((0, hessian.shape[0])))
        self.solver.setup(form(hessian), gradient, form(rows[equal]) if len(equal) else self.empty, upper[equal],
                          form(rows[self.rest]), None, upper[self.rest], None, None)

    def solve(self, gradient, lower, upper, warm):
        self.solver.update(c=gradient, b=upper[self.equal], h_u=upper[self.rest])
        status = self.solver.solve()
        info = self.solver.result.info
        return np.array(self.solver.result.x), (info.update_time + info.solve_time) * 1e9, status == self.ok, info.iter


class ProxQp:
    name = "ProxQP"

    def __init__(self, hessian, left, lower, upper, gradient):
        proxqp = importlib.import_module("proxsuite").proxqp
        self.kinds, equal = proxqp, np.flatnonzero(lower == upper)
        self.equal, self.rest = equal, np.setdiff1d(np.arange(len(upper)), equal)
        rows = sparse.csr_matrix(left)
        kind, form = (proxqp.dense, lambda matrix: matrix.toarray()) if len(equal) == 0 else (proxqp.sparse, sparse.csc_matrix)
        self.solver = kind.QP(hessian.shape[0], len(equal), len(self.rest))
        self.solver.settings.eps_abs = TOLERANCE
        self.solver.settings.compute_timings = True
        self.solver.init(form(hessian), gradient, form(rows[equal]) if len(equal) else None, upper[equal] if len(equal) else None,
                         form(rows[self.rest]), lower[self.rest], upper[self.rest])

    def solve(self, gradient, lower, upper, warm):
        guess = self.kinds.InitialGuess
        self.solver.settings.initial_guess = guess.WARM_START_WITH_PREVIOUS_RESULT if warm else guess.EQUALITY_CONSTRAINED_INITIAL_GUESS
        self.solver.update(g=gradient, b=upper[self.equal] if len(self.equal) else None, l=lower[self.rest], u=upper[self.rest])
        self.solver.solve()
        info = self.solver.results.info
        return self.solver.results.x.copy(), info.run_time * 1e3, "SOLVED" in str(info.status).upper(), info.iter


class Quadprog:
    name = "quadprog (wall clock)"

    def __init__(self, hessian, left, lower, upper, gradient):
        self.quadprog = importlib.import_module("quadprog")
        if np.any(lower == upper):
            raise ValueError("the Hessian of the full horizon is singular, which quadprog does not take")
        self.hessian, self.left = hessian.toarray(), np.ascontiguousarray(-sparse.csr_matrix(left).toarray().T)

    def solve(self, gradient, lower, upper, warm):
        begin = time.perf_counter_ns()
        result = self.quadprog.solve_qp(self.hessian, -gradient, self.left, -upper)
        return result[0], time.perf_counter_ns() - begin, True, int(result[3][0])


class Clarabel:
    name = "Clarabel"

    def __init__(self, hessian, left, lower, upper, gradient):
        clarabel = importlib.import_module("clarabel")
        self.module, settings = clarabel, clarabel.DefaultSettings()
        settings.verbose, settings.presolve_enable = False, False
        equal = np.flatnonzero(lower == upper)
        self.order = np.concatenate([equal, np.setdiff1d(np.arange(len(upper)), equal)])
        cones = [clarabel.ZeroConeT(len(equal))] if len(equal) else []
        cones.append(clarabel.NonnegativeConeT(len(upper) - len(equal)))
        rows = sparse.csc_matrix(sparse.csr_matrix(left)[self.order])
        self.solver = clarabel.DefaultSolver(sparse.triu(hessian, format="csc"), gradient, rows, upper[self.order], cones, settings)

    def solve(self, gradient, lower, upper, warm):
        self.solver.update(q=gradient, b=upper[self.order])
        result = self.solver.solve()
        return np.array(result.x), result.solve_time * 1e9, "Solved" in str(result.status), result.iterations


DENSE = [Osqp, Piqp, ProxQp, Quadprog]
HORIZON = [Osqp, Piqp, ProxQp, Clarabel]


def run(kind, hessian, left, samples, warm: bool):
    """Times a solver along samples: (flight, f, lower, upper) each. Returns times in ns, failures, most iterations and solutions."""
    _, gradient, lower, upper = samples[0]
    solver = kind(sparse.csc_matrix(hessian), sparse.csc_matrix(left), lower, upper, gradient)
    times, failures, most, solutions, last = [], 0, 0, [], None
    for flight, gradient, lower, upper in samples:
        z, taken_ns, solved, iterations = solver.solve(gradient, lower, upper, warm and flight == last)
        last = flight
        times.append(float(taken_ns))
        failures += not solved
        most = max(most, int(iterations))
        solutions.append(z if solved else None)
    return times, failures, most, solutions

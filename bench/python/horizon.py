"""The task of a loop written out over a full horizon: one move and one state per sample, as solvers for sparse programs take it."""

import numpy as np
from scipy import sparse


class Horizon:
    """min sum |[dx; y - r]|_Q + |du|_R + the regulator's cost of what comes after, over `moves` samples, under the limits of states and
    inputs at the samples at which the shipped controller has them (those beyond the horizon are left out, the others are hard).

    Unknowns: for each sample the input u(k) and the state deviation x(k + 1). The known state and u(k - 1) enter the right-hand side.
    """

    def __init__(self, task: dict, moves: int):
        n, p = task["states"], task["inputs"]
        self.n, self.p, self.moves = n, p, moves
        self.a, self.b, self.c = (np.array(task[name]).reshape(shape) for name, shape in (("a", (n, n)), ("b", (n, p)), ("c", (p, n))))
        q, r = np.array(task["q"]).reshape(n + p, n + p), np.array(task["r"]).reshape(p, p)
        terminal = np.array(task["terminal"]).reshape(n + p, n + p)
        self.size = moves * (n + p)
        hessian = sparse.lil_matrix((self.size, self.size))
        # The gradient is linear in [x(k); u(k - 1)].
        gradient = np.zeros((self.size, n + p))
        for k in range(moves):
            self._charge(hessian, gradient, self._change(k), r)
            weight = terminal if k == moves - 1 else q
            self._charge(hessian, gradient, self._motion(k), weight)
        self.hessian = sparse.csc_matrix(2 * hessian)
        self.gradient = 2 * gradient
        rows = [self._dynamics(k) for k in range(moves)]
        self.equal = sparse.csc_matrix(sparse.vstack([left for left, _ in rows]))
        self.equal_known = np.vstack([known for _, known in rows])
        self._limit(task)

    def _state(self, k: int) -> tuple[np.ndarray, np.ndarray]:
        """x(k) as a map of the unknowns and of what is known."""
        left, known = np.zeros((self.n, self.size)), np.zeros((self.n, self.n + self.p))
        if k == 0:
            known[:, : self.n] = np.eye(self.n)
        else:
            left[:, (k - 1) * (self.n + self.p) + self.p : k * (self.n + self.p)] = np.eye(self.n)
        return left, known

    def _input(self, k: int) -> tuple[np.ndarray, np.ndarray]:
        left, known = np.zeros((self.p, self.size)), np.zeros((self.p, self.n + self.p))
        if k < 0:
            known[:, self.n :] = np.eye(self.p)
        else:
            left[:, k * (self.n + self.p) : k * (self.n + self.p) + self.p] = np.eye(self.p)
        return left, known

    def _change(self, k: int):
        return tuple(now - before for now, before in zip(self._input(k), self._input(k - 1)))

    def _motion(self, k: int):
        """[x(k + 1) - x(k); y(k + 1) - r]."""
        now, next_one = self._state(k), self._state(k + 1)
        return tuple(np.vstack([after - before, self.c @ after]) for before, after in zip(now, next_one))

    @staticmethod
    def _charge(hessian, gradient, signal, weight) -> None:
        left, known = signal
        used = np.flatnonzero(np.any(left != 0, axis=0))
        part = left[:, used]
        hessian[np.ix_(used, used)] += part.T @ weight @ part
        gradient[used] += part.T @ weight @ known

    def _dynamics(self, k: int):
        """x(k + 1) - A x(k) - B u(k) = 0, as left z = known w."""
        parts = [np.eye(self.n), -self.a, -self.b]
        signals = [self._state(k + 1), self._state(k), self._input(k)]
        left, known = (sum(part @ signal[at] for part, signal in zip(parts, signals)) for at in (0, 1))
        return sparse.csr_matrix(left), -known

    def _limit(self, task: dict) -> None:
        left, known, upper, absolute = [], [], [], []
        for limit in task["limits"]:
            bounds = np.array(limit["upper"])
            of_state = np.array(limit["of_state"]).reshape(len(bounds), self.n)
            of_input = np.array(limit["of_input"]).reshape(len(bounds), self.p)
            for k in limit["samples"]:
                # At sample 0 the state is measured: nothing can be done about it.
                if k >= self.moves or (k == 0 and not of_input.any()):
                    continue
                state, input_now = self._state(k), self._input(k)
                left.append(sparse.csr_matrix(of_state @ state[0] + of_input @ input_now[0]))
                known.append(of_state @ state[1] + of_input @ input_now[1])
                # A limit of velocities and accelerations is one of deviations, too: the goal rests.
                absolute.append(of_state)
                upper.append(bounds)
        self.left = sparse.csc_matrix(sparse.vstack(left))
        self.known, self.upper = np.vstack(known), np.concatenate(upper)

    def at(self, moment: dict):
        """f, the right-hand side of the equalities, and that of the limits, at a moment of a flight."""
        w = np.concatenate([moment["deviation"], moment["input"]])
        return self.gradient @ w, self.equal_known @ w, self.upper - self.known @ w

    def first_move(self, z: np.ndarray, moment: dict) -> np.ndarray:
        return z[: self.p] - np.array(moment["input"])

"""HPIPM's interface for optimal control on full horizons: stages instead of one sparse matrix. Its state is [x; u(k - 1)], so that it may
weigh increments; the first one is known, so that only vectors of the first stage change from sample to sample."""

import ctypes
import tempfile
from pathlib import Path

import numpy as np

import peers_in_c
from statistics_of import summary


class Stage:
    """x' = A x + B u costs (x'Qx + u'Ru)/2 + u'Sx under C x + D u <= upper."""

    def __init__(self, task: dict, sample: int, weight: np.ndarray):
        n, p = task["states"], task["inputs"]
        shaped = lambda name, *shape: np.array(task[name]).reshape(shape)
        a, b, c, r = shaped("a", n, n), shaped("b", n, p), shaped("c", p, n), shaped("r", p, p)
        before = np.hstack([np.zeros((p, n)), np.eye(p)])
        self.a = np.vstack([np.hstack([a, np.zeros((n, p))]), np.zeros((p, n + p))])
        self.b = np.vstack([b, np.eye(p)])
        # [x(k + 1) - x(k); y(k + 1)], which the weight is on.
        by_state = np.hstack([np.vstack([a - np.eye(n), c @ a]), np.zeros((n + p, p))])
        by_input = np.vstack([b, c @ b])
        self.q = 2 * (by_state.T @ weight @ by_state + before.T @ r @ before)
        self.s = 2 * (by_input.T @ weight @ by_state - r @ before)
        self.r = 2 * (by_input.T @ weight @ by_input + r)
        rows = [np.zeros((0, n + 2 * p))]
        upper = [np.zeros(0)]
        for limit in task["limits"]:
            bounds = np.array(limit["upper"])
            of_state = np.array(limit["of_state"]).reshape(len(bounds), n)
            of_input = np.array(limit["of_input"]).reshape(len(bounds), p)
            # At sample 0 the state is measured: nothing can be done about it.
            if sample in limit["samples"] and (sample > 0 or of_input.any()):
                rows.append(np.hstack([of_state, np.zeros((len(bounds), p)), of_input]))
                upper.append(bounds)
        rows, self.upper = np.vstack(rows), np.concatenate(upper)
        self.c, self.d = rows[:, : n + p], rows[:, n + p :]

    def in_c(self) -> "StageInC":
        # The arrays live as long as the stage does.
        self.columns = [np.asfortranarray(each, dtype=float) for each in (self.a, self.b, self.q, self.s, self.r, self.c, self.d, self.upper)]
        return StageInC(len(self.upper), *(each.ctypes.data for each in self.columns))


class StageInC(ctypes.Structure):
    _fields_ = [("rows", ctypes.c_int), *((name, ctypes.c_void_p) for name in ("a", "b", "q", "s", "r", "c", "d", "upper"))]


class Solver:
    def __init__(self, library, stages: list[Stage]):
        self.library, self.first = library, stages[0]
        states, inputs = self.first.b.shape
        array = (StageInC * len(stages))(*(stage.in_c() for stage in stages))
        library.ocp_new.restype = ctypes.c_void_p
        self.ocp = ctypes.c_void_p(library.ocp_new(len(stages), states, inputs, array))
        vector = np.ctypeslib.ndpointer(dtype=float, flags="C")
        pointers = [ctypes.POINTER(kind) for kind in (ctypes.c_int, ctypes.c_double)]
        library.ocp_solve.argtypes = [ctypes.c_void_p, vector, vector, vector, ctypes.c_int, vector, *pointers]
        self.input = np.zeros(inputs)

    def __del__(self):
        self.library.ocp_free(self.ocp)

    def solve(self, state: np.ndarray, warm: bool):
        """The first input, the time, ns, whether it is solved, and the iterations."""
        first, iterations, taken_ns = self.first, ctypes.c_int(), ctypes.c_double()
        vectors = [first.a @ state, first.s @ state, first.upper - first.c @ state]
        failed = self.library.ocp_solve(self.ocp, *vectors, int(warm), self.input, ctypes.byref(iterations), ctypes.byref(taken_ns))
        return self.input.copy(), taken_ns.value, failed == 0, iterations.value


def compiled(folder: Path):
    library = folder / "hpipm_ocp.so"
    peers_in_c.build(Path(__file__).parent.parent / "peers" / "hpipm_ocp.c", library, peers_in_c.hpipm(folder))
    return ctypes.CDLL(str(library))


def stages(task: dict, moves: int) -> list[Stage]:
    size = task["states"] + task["inputs"]
    weights = [np.array(task[name]).reshape(size, size) for name in ("q", "terminal")]
    return [Stage(task, sample, weights[sample == moves - 1]) for sample in range(moves)]


def run(solver: Solver, task: dict, moments, warm: bool):
    """Times in ns, failures, most iterations and first inputs."""
    times, failures, most, inputs, last = [], 0, 0, [], None
    for at in moments:
        moment = task["moments"][at]
        state = np.array([*moment["deviation"], *moment["input"]])
        first, taken_ns, solved, iterations = solver.solve(state, warm and moment["flight"] == last)
        last = moment["flight"]
        times.append(taken_ns)
        failures += not solved
        most = max(most, iterations)
        inputs.append(first if solved else None)
    return times, failures, most, inputs


def measured(task: dict, moments, moves: int, limited, count: int) -> list[dict]:
    """Cold and warm, in so many passes, of which the shortest time of each sample counts."""
    with tempfile.TemporaryDirectory() as folder:
        library = compiled(Path(folder))
    parts = stages(task, moves)
    found = []
    for warm in (False, True):
        passes = [run(Solver(library, parts), task, moments, warm) for _ in range(count)]
        times = [min(each) for each in zip(*(one[0] for one in passes))]
        _, failures, most, _ = passes[0]
        found.append({"loop": task["program"]["name"], "solver": "HPIPM (stages)", "kind": "horizon", "moves": moves, "warm": warm,
                      "unknowns": moves * (parts[0].a.shape[0] + task["inputs"]), "rows": sum(len(part.upper) for part in parts),
                      "failures": failures, "most_iterations": most,
                      "times_ns": {"all": summary(times), "limited": summary([t for t, at in zip(times, limited) if at])}})
    return found

"""OSQP's generated C code, as one would put it on a flight controller: one library for each program."""

import ctypes
import importlib
import tempfile
from pathlib import Path

import numpy as np

import peers_in_c
from solvers import TOLERANCE


class OsqpEmbedded:
    """Only vectors change from sample to sample. The penalty stays as OSQP has adapted it to the first sample."""

    name = "OSQP, generated code"
    #: Libraries by what they were generated from: compiling one takes seconds.
    libraries = {}

    def __init__(self, hessian, left, lower, upper, gradient):
        program = b"".join(matrix.data.tobytes() for matrix in (hessian, left))
        if program not in self.libraries:
            self.libraries[program] = generated(hessian, left, lower, upper, gradient)
        self.solve_embedded = self.libraries[program].embedded_solve
        array = np.ctypeslib.ndpointer(dtype=float, flags="C")
        pointers = [ctypes.POINTER(kind) for kind in (ctypes.c_int, ctypes.c_double)]
        self.solve_embedded.argtypes = [array, array, array, ctypes.c_int, ctypes.c_int, array, *pointers]
        self.z = np.zeros(hessian.shape[0])

    def solve(self, gradient, lower, upper, warm):
        iterations, taken_ns = ctypes.c_int(), ctypes.c_double()
        vectors = [np.ascontiguousarray(vector, dtype=float) for vector in (gradient, lower, upper)]
        counters = ctypes.byref(iterations), ctypes.byref(taken_ns)
        failed = self.solve_embedded(*vectors, int(warm), len(self.z), self.z, *counters)
        return self.z.copy(), taken_ns.value, failed == 0, iterations.value


def generated(hessian, left, lower, upper, gradient) -> ctypes.CDLL:
    """The library of a program."""
    solver = importlib.import_module("osqp").OSQP()
    solver.setup(hessian, gradient, left, lower, upper, verbose=False, eps_abs=TOLERANCE, eps_rel=TOLERANCE, max_iter=4000, polishing=False)
    solver.solve()
    with tempfile.TemporaryDirectory() as folder:
        solver.codegen(folder, parameters="vectors", extension_name=None, force_rewrite=True)
        return ctypes.CDLL(str(compiled(Path(folder))))


def compiled(folder: Path) -> Path:
    """The library of the code that OSQP has generated into a folder."""
    sources = Path(__file__).parent.parent / "peers"
    library = folder / "embedded.so"
    headers = [f"-I{folder / part}" for part in ("", "inc/public", "inc/private")]
    peers_in_c.build(sources / "osqp_embedded.c", library, [*headers, folder / "workspace.c", *sorted((folder / "src").glob("*.c"))])
    return library

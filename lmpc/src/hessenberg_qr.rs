//! Eigenvalues of an upper Hessenberg matrix by Francis's double-shift QR iteration.

use alloc::vec;
use alloc::vec::Vec;

use nalgebra::{Complex, DMatrix};

/// Sweeps without an eigenvalue after which the iteration is given up; it needs two or three.
const MAXIMUM_SWEEPS: usize = 300;
/// Every so many sweeps without an eigenvalue the shifts are replaced. Those of the trailing block leave an orthogonal
/// matrix, such as a cyclic permutation, as it is.
const SWEEPS_BETWEEN_EXCEPTIONAL_SHIFTS: usize = 10;

/// All eigenvalues of an upper Hessenberg matrix, in the order of its Schur form; `None` when the iteration does not
/// converge.
///
/// The algorithm of Martin, Peters and Wilkinson (1970, Numerische Mathematik 14, `hqr`) with their exceptional shifts.
pub(crate) fn hessenberg_eigenvalues(matrix: DMatrix<f64>) -> Option<Vec<Complex<f64>>> {
    HessenbergQr::new(matrix).run()
}

struct HessenbergQr {
    h: DMatrix<f64>,
    /// What exceptional shifts have taken off the diagonal.
    shift: f64,
    /// ‖H‖, for diagonals that are zero.
    norm: f64,
    eigenvalues: Vec<Complex<f64>>,
}

/// The two shifts of a sweep, as the trailing block's x = h_nn, y = h_(n−1)(n−1) and w = h_n(n−1) h_(n−1)n.
#[derive(Clone, Copy)]
struct Shifts {
    x: f64,
    y: f64,
    w: f64,
}

/// A Householder vector of up to three elements.
#[derive(Clone, Copy, Default)]
struct Bulge {
    p: f64,
    q: f64,
    r: f64,
}

impl Bulge {
    /// The same direction, with |p| + |q| + |r| = 1, and what it was divided by.
    fn scaled(self) -> (Self, f64) {
        let Self { p, q, r } = self;
        let size = libm::fabs(p) + libm::fabs(q) + libm::fabs(r);
        if size > 0.0 { (Self { p: p / size, q: q / size, r: r / size }, size) } else { (self, size) }
    }

    /// ‖·‖ with the sign of p.
    fn signed_norm(self) -> f64 {
        libm::copysign(libm::sqrt(self.p * self.p + self.q * self.q + self.r * self.r), self.p)
    }
}

impl HessenbergQr {
    fn new(h: DMatrix<f64>) -> Self {
        let eigenvalues = vec![Complex::new(0.0, 0.0); h.nrows()];
        Self { norm: h.norm(), h, shift: 0.0, eigenvalues }
    }

    fn run(mut self) -> Option<Vec<Complex<f64>>> {
        // Rows from `size` on are done.
        let mut size = self.h.nrows();
        let mut sweeps = 0;
        while size > 0 {
            let last = size - 1;
            let first = self.first_of_unreduced(last);
            match last - first {
                0 => {
                    self.eigenvalues[last] = Complex::new(self.h[(last, last)] + self.shift, 0.0);
                    (size, sweeps) = (size - 1, 0);
                }
                1 => {
                    self.take_pair(last);
                    (size, sweeps) = (size - 2, 0);
                }
                _ if sweeps == MAXIMUM_SWEEPS => return None,
                _ => {
                    let exceptional = sweeps > 0 && sweeps % SWEEPS_BETWEEN_EXCEPTIONAL_SHIFTS == 0;
                    let shifts = if exceptional { self.exceptional_shifts(last) } else { self.shifts(last) };
                    self.sweep(first, last, shifts);
                    sweeps += 1;
                }
            }
        }
        self.eigenvalues
            .iter()
            .all(|value| value.re.is_finite() && value.im.is_finite())
            .then_some(self.eigenvalues)
    }

    /// Where the block that ends with row `last` begins: below the last subdiagonal element that is rounding, which
    /// becomes zero.
    fn first_of_unreduced(&mut self, last: usize) -> usize {
        for row in (1..=last).rev() {
            let diagonal = libm::fabs(self.h[(row - 1, row - 1)]) + libm::fabs(self.h[(row, row)]);
            let size = if diagonal > 0.0 { diagonal } else { self.norm };
            if libm::fabs(self.h[(row, row - 1)]) <= f64::EPSILON * size {
                self.h[(row, row - 1)] = 0.0;
                return row;
            }
        }
        0
    }

    /// Both eigenvalues of the 2×2 block that ends with row `last`.
    fn take_pair(&mut self, last: usize) {
        let Shifts { x, y, w } = self.shifts(last);
        let half = 0.5 * (y - x);
        let discriminant = half * half + w;
        let root = libm::sqrt(libm::fabs(discriminant));
        let x = x + self.shift;
        let (one, other) = if discriminant >= 0.0 {
            // The larger difference first: the other follows from the product of the roots.
            let far = half + libm::copysign(root, half);
            let near = if far == 0.0 { 0.0 } else { -w / far };
            (Complex::new(x + far, 0.0), Complex::new(x + near, 0.0))
        } else {
            (Complex::new(x + half, root), Complex::new(x + half, -root))
        };
        self.eigenvalues[last - 1] = one;
        self.eigenvalues[last] = other;
    }

    /// The eigenvalues of the trailing block.
    fn shifts(&self, last: usize) -> Shifts {
        let h = &self.h;
        Shifts {
            x: h[(last, last)],
            y: h[(last - 1, last - 1)],
            w: h[(last, last - 1)] * h[(last - 1, last)],
        }
    }

    /// Shifts that have nothing to do with the spectrum.
    fn exceptional_shifts(&mut self, last: usize) -> Shifts {
        let x = self.h[(last, last)];
        self.shift += x;
        for i in 0..=last {
            self.h[(i, i)] -= x;
        }
        let size = libm::fabs(self.h[(last, last - 1)]) + libm::fabs(self.h[(last - 1, last - 2)]);
        Shifts { x: 0.75 * size, y: 0.75 * size, w: -0.4375 * size * size }
    }

    /// The first column of (H − σ₁)(H − σ₂) from row m on.
    fn first_column(&self, m: usize, shifts: Shifts) -> Bulge {
        let h = &self.h;
        let (from_x, from_y) = (shifts.x - h[(m, m)], shifts.y - h[(m, m)]);
        let bulge = Bulge {
            p: (from_x * from_y - shifts.w) / h[(m + 1, m)] + h[(m, m + 1)],
            q: h[(m + 1, m + 1)] - h[(m, m)] - from_x - from_y,
            r: h[(m + 2, m + 1)],
        };
        bulge.scaled().0
    }

    /// One double QR step on rows `first` to `last`, at least three of them.
    fn sweep(&mut self, first: usize, last: usize, shifts: Shifts) {
        // Two consecutive small subdiagonal elements let the step start below them.
        let mut m = last - 2;
        let mut start = self.first_column(m, shifts);
        while m > first {
            let h = &self.h;
            let below = libm::fabs(h[(m, m - 1)]) * (libm::fabs(start.q) + libm::fabs(start.r));
            let diagonal =
                libm::fabs(h[(m - 1, m - 1)]) + libm::fabs(h[(m, m)]) + libm::fabs(h[(m + 1, m + 1)]);
            if below <= f64::EPSILON * libm::fabs(start.p) * diagonal {
                break;
            }
            m -= 1;
            start = self.first_column(m, shifts);
        }
        for row in m + 2..=last {
            self.h[(row, row - 2)] = 0.0;
            if row > m + 2 {
                self.h[(row, row - 3)] = 0.0;
            }
        }
        for k in m..last {
            let three = k + 1 < last;
            let (bulge, size) = if k == m {
                (start, 1.0)
            } else {
                let r = if three { self.h[(k + 2, k - 1)] } else { 0.0 };
                Bulge { p: self.h[(k, k - 1)], q: self.h[(k + 1, k - 1)], r }.scaled()
            };
            let norm = bulge.signed_norm();
            if norm == 0.0 {
                continue;
            }
            if k > m {
                self.h[(k, k - 1)] = -norm * size;
            } else if m > first {
                self.h[(k, k - 1)] = -self.h[(k, k - 1)];
            }
            self.reflect(k, first, last, bulge, norm);
        }
    }

    /// Applies the reflection of a bulge to rows and columns k, k + 1 and, above `last`, k + 2.
    fn reflect(&mut self, k: usize, first: usize, last: usize, bulge: Bulge, norm: f64) {
        let h = &mut self.h;
        let three = k + 1 < last;
        let p = bulge.p + norm;
        let (x, y, z) = (p / norm, bulge.q / norm, bulge.r / norm);
        let (q, r) = (bulge.q / p, bulge.r / p);
        for j in k..=last {
            let mut along = h[(k, j)] + q * h[(k + 1, j)];
            if three {
                along += r * h[(k + 2, j)];
                h[(k + 2, j)] -= along * z;
            }
            h[(k + 1, j)] -= along * y;
            h[(k, j)] -= along * x;
        }
        for i in first..=last.min(k + 3) {
            let mut along = x * h[(i, k)] + y * h[(i, k + 1)];
            if three {
                along += z * h[(i, k + 2)];
                h[(i, k + 2)] -= along * r;
            }
            h[(i, k + 1)] -= along * q;
            h[(i, k)] -= along;
        }
    }
}

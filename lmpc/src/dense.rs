//! Inner loops over slices of equal length.

/// Σ aᵢ bᵢ in four partial sums, which the compiler turns into vector instructions.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    let (a_chunks, a_rest) = a.as_chunks::<4>();
    let (b_chunks, b_rest) = b.as_chunks::<4>();
    for (x, y) in a_chunks.iter().zip(b_chunks) {
        for lane in 0..4 {
            sums[lane] += x[lane] * y[lane];
        }
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(x, y)| x * y).sum();
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest
}

/// a ← a − t b.
pub(crate) fn subtract_scaled(a: &mut [f64], b: &[f64], t: f64) {
    for (x, y) in a.iter_mut().zip(b) {
        *x -= t * y;
    }
}

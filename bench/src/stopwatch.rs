//! The clock, less what it costs to read it.

use std::time::Instant;

/// A clock that knows what its own reading costs.
#[derive(Clone, Copy, Debug)]
pub struct Stopwatch {
    reading_ns: f64,
}

impl Stopwatch {
    /// Measures the cost of a reading: the least of many.
    pub fn calibrated() -> Self {
        let reading = || {
            let start = Instant::now();
            start.elapsed().as_nanos() as f64
        };
        Self { reading_ns: (0..10_000).map(|_| reading()).fold(f64::INFINITY, f64::min) }
    }

    /// A clock whose reading counts: for what is so long that it does not matter.
    pub fn free() -> Self {
        Self { reading_ns: 0.0 }
    }

    /// How long something takes, ns.
    pub fn time(&self, work: impl FnOnce()) -> f64 {
        let start = Instant::now();
        work();
        (start.elapsed().as_nanos() as f64 - self.reading_ns).max(0.0)
    }

    /// How long one of several calls takes, ns, for what is about as short as a reading of the clock.
    pub fn time_each(&self, count: u32, mut work: impl FnMut()) -> f64 {
        self.time(|| (0..count).for_each(|_| work())) / f64::from(count)
    }
}

#[cfg(test)]
mod tests {
    use super::Stopwatch;

    /// No bound from above: a busy machine may stop anything for any time.
    #[test]
    fn nothing_takes_no_negative_time_and_work_takes_some() {
        let watch = Stopwatch::calibrated();
        assert!(watch.time(|| {}) >= 0.0);
        let mut sum = 0.0_f64;
        let taken_ns = watch.time(|| (0..100_000).for_each(|number| sum += f64::from(number).sqrt()));
        assert!(taken_ns > 0.0 && sum > 0.0);
    }
}

//! From values to places along an axis, with round numbers on it.

/// How values are spread.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Evenly.
    Linear,
    /// By their logarithm.
    Logarithmic,
}

/// An axis over some values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisRange {
    scale: Scale,
    low: f64,
    high: f64,
}

impl AxisRange {
    /// An axis that shows all `values`, and spans at least `span` in linear scale: rounding errors of what rests are
    /// not blown up. Values that a logarithm does not take are left out.
    pub fn around(values: impl IntoIterator<Item = f64>, scale: Scale, span: f64) -> Self {
        let usable = |value: &f64| value.is_finite() && (scale == Scale::Linear || *value > 0.0);
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for value in values.into_iter().filter(usable) {
            (low, high) = (low.min(value), high.max(value));
        }
        if low > high {
            (low, high) = (1.0, 1.0);
        }
        match scale {
            Scale::Linear => {
                if high - low < span {
                    let middle = (low + high) / 2.0;
                    (low, high) = (middle - span / 2.0, middle + span / 2.0);
                }
                let margin = if high > low { 0.05 * (high - low) } else { 0.5 };
                Self { scale, low: low - margin, high: high + margin }
            }
            Scale::Logarithmic => Self { scale, low: low / 1.3, high: high * 1.3 },
        }
    }

    /// An axis from exactly one value to another.
    pub fn exactly(low: f64, high: f64, scale: Scale) -> Self {
        Self { scale, low, high }
    }

    /// 0 at the lower end, 1 at the upper.
    pub fn share(&self, value: f64) -> f64 {
        match self.scale {
            Scale::Linear => (value - self.low) / (self.high - self.low),
            Scale::Logarithmic => {
                // What is zero or negative stands far below.
                let value = value.max(self.low * 1e-3);
                (value / self.low).ln() / (self.high / self.low).ln()
            }
        }
    }

    /// Round values within the axis, about `count` of them, and their names.
    pub fn ticks(&self, count: usize) -> Vec<(f64, String)> {
        match self.scale {
            Scale::Linear => self.linear_ticks(count),
            Scale::Logarithmic => self.logarithmic_ticks(),
        }
    }

    fn linear_ticks(&self, count: usize) -> Vec<(f64, String)> {
        let rough = (self.high - self.low) / count.max(1) as f64;
        let power = 10_f64.powf(rough.log10().floor());
        let step = [1.0, 2.0, 5.0, 10.0].map(|factor| factor * power);
        let step = step.into_iter().find(|step| *step >= rough).unwrap_or(rough);
        let decimals = (-step.log10().floor()).max(0.0) as usize;
        let first = (self.low / step - 1e-9).ceil() as i64;
        let last = (self.high / step + 1e-9).floor() as i64;
        (first..=last)
            .map(|index| {
                let value = index as f64 * step;
                (value, typographic(&format!("{value:.decimals$}")))
            })
            .collect()
    }

    fn logarithmic_ticks(&self) -> Vec<(f64, String)> {
        let decades = (self.high / self.low).log10();
        let factors: &[f64] = match decades {
            decades if decades > 2.5 => &[1.0],
            decades if decades > 1.2 => &[1.0, 3.0],
            _ => &[1.0, 2.0, 5.0],
        };
        let (first, last) = (self.low.log10().floor() as i32, self.high.log10().ceil() as i32);
        (first..=last)
            .flat_map(|power| factors.iter().map(move |factor| factor * 10_f64.powi(power)))
            .filter(|value| (0.0..=1.0).contains(&self.share(*value)))
            .map(|value| (value, short(value)))
            .collect()
    }
}

/// A number of any size in few characters.
pub fn short(value: f64) -> String {
    let size = value.abs();
    let text = if value == 0.0 {
        "0".to_owned()
    } else if !(1e-4..1e5).contains(&size) {
        format!("{value:.0e}")
    } else {
        let decimals = (-size.log10().floor()).max(0.0) as usize;
        format!("{value:.decimals$}")
    };
    typographic(&text)
}

/// A minus is not a hyphen.
fn typographic(text: &str) -> String {
    let negative_zero = text.starts_with('-') && text.chars().all(|c| matches!(c, '-' | '0' | '.'));
    if negative_zero { text[1..].to_owned() } else { text.replace('-', "−") }
}

#[cfg(test)]
mod tests {
    use super::{AxisRange, Scale, short};

    #[test]
    fn ticks_are_round_and_inside() {
        let names = |range: AxisRange| range.ticks(5).into_iter().map(|(_, name)| name).collect::<Vec<_>>();
        assert_eq!(names(AxisRange::exactly(-0.3, 1.0, Scale::Linear)), ["0.0", "0.5", "1.0"]);
        assert_eq!(names(AxisRange::exactly(-20.0, 10.0, Scale::Linear)), ["−20", "−10", "0", "10"]);
        assert_eq!(
            names(AxisRange::exactly(0.01, 100.0, Scale::Logarithmic)),
            ["0.01", "0.1", "1", "10", "100"]
        );
    }

    #[test]
    fn what_rests_is_not_blown_up() {
        let range = AxisRange::around([1.0, 1.0 + 1e-12], Scale::Linear, 0.5);
        assert!((range.share(1.0) - 0.5).abs() < 0.01);
        assert!(AxisRange::around([f64::NAN, -1.0], Scale::Logarithmic, 0.0).share(1.0).is_finite());
    }

    #[test]
    fn numbers_are_short() {
        assert_eq!([0.0, 0.3, -2.0, 1e6].map(short), ["0", "0.3", "−2", "1e6"]);
    }
}

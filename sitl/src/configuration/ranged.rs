//! Parsers of numbers on the command line, and their ranges.

use core::fmt::Display;
use core::str::FromStr;

/// A parser of whole numbers from `least` to `most`; the error names the range.
pub fn whole<T>(least: T, most: T) -> impl Fn(&str) -> Result<T, String> + Clone + Send + Sync + 'static
where
    T: FromStr + PartialOrd + Display + Clone + Send + Sync + 'static,
{
    within("whole number", least, most)
}

/// A parser of numbers from `least` to `most`; the error names the range.
pub fn number(least: f64, most: f64) -> impl Fn(&str) -> Result<f64, String> + Clone + Send + Sync + 'static {
    within("number", least, most)
}

/// A parser of any whole number that is not negative.
pub fn non_negative(text: &str) -> Result<u64, String> {
    text.trim().parse().map_err(|_| format!("must be a non-negative integer, not `{text}`"))
}

/// Finite numbers between commas; `None` if one of them is not.
pub fn numbers(text: &str) -> Option<Vec<f64>> {
    text.split(',').map(|word| word.trim().parse::<f64>().ok().filter(|value| value.is_finite())).collect()
}

fn within<T>(
    what: &'static str,
    least: T,
    most: T,
) -> impl Fn(&str) -> Result<T, String> + Clone + Send + Sync + 'static
where
    T: FromStr + PartialOrd + Display + Clone + Send + Sync + 'static,
{
    move |text| {
        let value = text.trim().parse().ok();
        // NaN is in no range.
        value
            .filter(|value| (&least..=&most).contains(&value))
            .ok_or_else(|| format!("`{text}` is not a {what} from {least} to {most}"))
    }
}

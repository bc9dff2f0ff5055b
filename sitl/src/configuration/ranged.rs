//! How numbers of the command line are read, and within which ranges.

use core::fmt::Display;
use core::str::FromStr;

/// A parser of whole numbers from `least` to `most`, which its refusal names.
pub fn whole<T>(least: T, most: T) -> impl Fn(&str) -> Result<T, String> + Clone + Send + Sync + 'static
where
    T: FromStr + PartialOrd + Display + Clone + Send + Sync + 'static,
{
    within("whole number", least, most)
}

/// A parser of numbers from `least` to `most`, which its refusal names.
pub fn number(least: f64, most: f64) -> impl Fn(&str) -> Result<f64, String> + Clone + Send + Sync + 'static {
    within("number", least, most)
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
            .ok_or_else(|| format!("`{text}` is no {what} within {least} to {most}"))
    }
}

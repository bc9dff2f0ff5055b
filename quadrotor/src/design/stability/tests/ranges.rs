//! Declared ranges at both ends, and random combinations: what is accepted without a word flies.

extern crate std;
use std::string::{String, ToString};
use std::vec::Vec;
use std::{format, println};

use chacha20::ChaCha8Rng;
use chacha20::rand_core::{Rng, SeedableRng};

use super::flight::{End, designed, fly_a_metre};
use crate::design::stability::verdict::judged;
use crate::{Access, Configuration, ControllerKind, PARAMETERS, Parameter};

/// Configurations by what was said of them and how they flew.
#[derive(Debug, Default)]
struct Tally {
    /// Accepted without a word: flown, lost.
    accepted: [u32; 2],
    warned: [u32; 2],
    refused: [u32; 2],
    /// No controller can be designed, or values contradict one another.
    undesignable: u32,
    /// What was accepted without a word and lost, …
    silent_losses: Vec<String>,
    /// … and what a controller was designed of with figures that are not finite.
    not_finite: Vec<String>,
}

impl Tally {
    fn add(&mut self, name: &str, configuration: &Configuration, duration_s: f64) {
        let Ok(design) = designed(configuration) else {
            self.undesignable += 1;
            return;
        };
        let figures = design.cascade.reports().into_iter().flat_map(|(_, report)| {
            [report.spectral_radius, report.eigenvalue_difference_to_dlqr, report.condition_number]
        });
        if figures.into_iter().any(|figure| !figure.is_finite()) {
            self.not_finite.push(name.to_string());
        }
        let verdict = judged(configuration, &design.cascade, None);
        let lost = usize::from(fly_a_metre(design, duration_s) == End::Lost);
        match verdict {
            Ok(report) if report.warnings().is_empty() => {
                self.accepted[lost] += 1;
                if lost == 1 {
                    self.silent_losses.push(name.to_string());
                }
            }
            Ok(_) => self.warned[lost] += 1,
            Err(_) => self.refused[lost] += 1,
        }
    }

    fn assert_no_silent_loss(&self) {
        println!("{self:?}");
        assert!(self.silent_losses.is_empty(), "accepted and lost: {:?}", self.silent_losses);
        assert!(self.not_finite.is_empty(), "figures not finite: {:?}", self.not_finite);
    }
}

/// Where a flight begins does not describe the vehicle.
fn describes_the_vehicle(parameter: &&Parameter) -> bool {
    !(parameter.name.starts_with("initial.") || parameter.name == "environment.ground_plane")
}

fn range(parameter: &Parameter) -> (f64, f64) {
    match parameter.access {
        Access::Real { minimum, maximum, .. } => (minimum, maximum),
        Access::Integer { minimum, maximum, .. } => (f64::from(minimum), f64::from(maximum)),
        Access::Enumeration { choice, .. } => (1.0, choice.items.len() as f64),
        Access::Boolean { .. } => (0.0, 1.0),
    }
}

fn set(configuration: &mut Configuration, parameter: &Parameter, value: f64) {
    match parameter.access {
        Access::Real { set, .. } => set(configuration, value),
        Access::Integer { set, .. } | Access::Enumeration { set, .. } => set(configuration, value as i32),
        Access::Boolean { set, .. } => set(configuration, value > 0.5),
    }
}

#[test]
fn whatever_a_single_end_of_a_range_is_said_to_fly_flies() {
    let mut tally = Tally::default();
    for parameter in PARAMETERS.iter().filter(describes_the_vehicle) {
        let (minimum, maximum) = range(parameter);
        for value in [minimum, maximum] {
            let mut configuration = Configuration::default();
            set(&mut configuration, parameter, value);
            tally.add(&format!("{} = {value:e}", parameter.name), &configuration, 4.0);
        }
    }
    tally.assert_no_silent_loss();
    // Most ends fly.
    assert!(tally.accepted[0] > tally.refused[0] + tally.undesignable, "{tally:?}");
}

/// A value of a range: an end, or any size of number within.
fn any_value(generator: &mut ChaCha8Rng, parameter: &Parameter) -> f64 {
    let mut share = || f64::from(generator.next_u32()) / f64::from(u32::MAX);
    let (minimum, maximum) = range(parameter);
    let place = share();
    if place < 0.2 {
        return if place < 0.1 { minimum } else { maximum };
    }
    let least = if minimum > 0.0 { minimum } else { maximum * 1e-6 };
    let is_wide = minimum >= 0.0 && maximum / least > 50.0 && matches!(parameter.access, Access::Real { .. });
    let value = if is_wide {
        least * (maximum / least).powf(share())
    } else {
        minimum + (maximum - minimum) * share()
    };
    if matches!(parameter.access, Access::Real { .. }) { value } else { value.round() }
}

#[test]
fn whatever_a_random_combination_of_three_is_said_to_fly_flies() {
    let mut generator = ChaCha8Rng::seed_from_u64(13);
    let parameters: Vec<_> = PARAMETERS.iter().filter(describes_the_vehicle).collect();
    let mut tally = Tally::default();
    for number in 0..120_u32 {
        let mut configuration = Configuration::default();
        // The slow one to design is one of six.
        configuration.controllers.kind = match number % 6 {
            0 => ControllerKind::StateSpaceMpc,
            1 | 2 => ControllerKind::Dlqr,
            _ => ControllerKind::Lmpc,
        };
        configuration.sensors.output_feedback = number % 4 == 0;
        let mut name = format!("{:?}", configuration.controllers.kind);
        for _ in 0..3 {
            let index = generator.next_u32() as usize % parameters.len();
            if let Some(parameter) = parameters.get(index) {
                let value = any_value(&mut generator, parameter);
                set(&mut configuration, parameter, value);
                name.push_str(&format!(" {} = {value:e}", parameter.name));
            }
        }
        tally.add(&name, &configuration, 4.0);
    }
    tally.assert_no_silent_loss();
    assert!(tally.refused[0] + tally.refused[1] > 0 && tally.accepted[0] > 30, "{tally:?}");
}

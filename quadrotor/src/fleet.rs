//! Many flights at once.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::num::NonZeroUsize;

use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use thiserror::Error;

use crate::design::design_cache::is_same;
use crate::kinds::Kinds;
use crate::lane_flight::{LaneFlight, advance_lanes};
use crate::plant::lanes::LANES;
use crate::{
    Configuration, ConfigurationError, InputSignal, Inputs, Outputs, PreparedDesign, Simulation,
    SimulationError,
};

/// Many vehicles that fly side by side on all cores. The plants of vehicles with the same airframe step together, by vector
/// instructions. Each flight is the one that it would be alone, bit for bit, however many there are and on however many threads: a
/// vehicle that cannot go on stops where it is, and the others fly on.
///
/// ```
/// use quadrotor::{Configuration, Fleet, Inputs, PositionReference};
///
/// # if !cfg!(feature = "shaper") { return Ok(()); }
/// // A hundred vehicles with masses from 0.5 to 0.7 kg, each to a place of its own.
/// let configurations: Vec<Configuration> = (0..100)
///     .map(|vehicle| {
///         let mut configuration = Configuration::default();
///         configuration.airframe.mass_kg = 0.5 + 0.2 * f64::from(vehicle / 10) / 9.0;
///         configuration
///     })
///     .collect();
/// let inputs = |vehicle: usize| Inputs {
///     reference: PositionReference::goal([vehicle as f64, 0.0, -2.0], 0.0),
///     ..Inputs::default()
/// };
/// let mut fleet = Fleet::new(&configurations, inputs)?; // ten designs
/// fleet.advance_to(1_000_000, inputs); // µs
/// assert!(fleet.failures().all(|failure| failure.is_none()));
/// assert!(fleet.outputs().iter().all(|outputs| outputs.position_m.z < 0.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// A fleet can be of anything that flies: [`Fleet::of`].
#[derive(Debug)]
pub struct Fleet<V = Simulation> {
    members: Vec<Member<V>>,
    threads: ThreadPool,
}

/// A vehicle of a fleet that may contain a closed loop, which then flies [side by side](Fleet::advance_side_by_side) with those of others.
pub trait ClosedLoopVehicle {
    /// Its closed loop, if it has one.
    fn closed_loop(&self) -> Option<&Simulation>;

    /// The same closed loop, mutable.
    fn closed_loop_mut(&mut self) -> Option<&mut Simulation>;
}

impl ClosedLoopVehicle for Simulation {
    fn closed_loop(&self) -> Option<&Simulation> {
        Some(self)
    }

    fn closed_loop_mut(&mut self) -> Option<&mut Simulation> {
        Some(self)
    }
}

/// A vehicle of a fleet.
#[derive(Debug)]
struct Member<V> {
    vehicle: V,
    /// Why it could not go on.
    failure: Option<SimulationError>,
}

/// Why there is no fleet.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum FleetError {
    /// A vehicle cannot fly as it is configured.
    #[error("vehicle {vehicle}: {error}")]
    Configuration {
        /// The first of those with this configuration, counted from 0.
        vehicle: usize,
        /// Why.
        error: ConfigurationError,
    },
    /// The system gives no threads.
    #[error("cannot start the threads of a fleet: {reason}; ask for fewer")]
    Threads {
        /// What the system says.
        reason: String,
    },
}

impl<V: Send + Sync> Fleet<V> {
    /// A fleet of these vehicles on so many threads; `None` is one for each core.
    ///
    /// # Errors
    /// [`FleetError::Threads`].
    pub fn of(vehicles: Vec<V>, threads: Option<NonZeroUsize>) -> Result<Self, FleetError> {
        let members = vehicles.into_iter().map(|vehicle| Member { vehicle, failure: None }).collect();
        Ok(Self { members, threads: pool(threads)? })
    }

    /// How many vehicles there are.
    pub fn len(&self) -> usize {
        self.members.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.members.is_empty()
    }

    /// The vehicles, in their order.
    pub fn vehicles(&self) -> impl ExactSizeIterator<Item = &V> {
        self.members.iter().map(|member| &member.vehicle)
    }

    /// The same, to be changed. One that has failed does not fly before [`Fleet::replace_each`] has replaced it.
    pub fn vehicles_mut(&mut self) -> impl ExactSizeIterator<Item = &mut V> {
        self.members.iter_mut().map(|member| &mut member.vehicle)
    }

    /// Why each vehicle could not go on, if it could not.
    pub fn failures(&self) -> impl ExactSizeIterator<Item = Option<&SimulationError>> {
        self.members.iter().map(|member| member.failure.as_ref())
    }

    /// Lets each vehicle that has not failed fly on, by its index and on several threads. One that refuses has failed.
    pub fn advance_each(&mut self, advance: impl Fn(usize, &mut V) -> Result<(), SimulationError> + Sync) {
        let Self { members, threads } = self;
        threads.install(|| {
            members.par_iter_mut().enumerate().for_each(|(index, member)| {
                if member.failure.is_none() {
                    member.failure = advance(index, &mut member.vehicle).err();
                }
            });
        });
    }

    /// What can be seen of each vehicle, looked at by its index and on several threads.
    pub fn map<R: Send>(&self, look: impl Fn(usize, &V) -> R + Sync) -> Vec<R> {
        let Self { members, threads } = self;
        threads.install(|| {
            members.par_iter().enumerate().map(|(index, member)| look(index, &member.vehicle)).collect()
        })
    }

    /// Replaces vehicles, by their indices and on several threads: restores or restarts them. `replacement` returns what flies instead of
    /// a vehicle, even if that had failed, or `None` if it stays. All are replaced, or none.
    ///
    /// # Errors
    /// That of the first vehicle without a replacement.
    pub fn replace_each<E: Send>(
        &mut self,
        replacement: impl Fn(usize, &V) -> Result<Option<V>, E> + Sync,
    ) -> Result<(), E> {
        let replacements: Result<Vec<Option<V>>, E> = self.map(replacement).into_iter().collect();
        for (member, replacement) in self.members.iter_mut().zip(replacements?) {
            if let Some(vehicle) = replacement {
                *member = Member { vehicle, failure: None };
            }
        }
        Ok(())
    }
}

impl<V: ClosedLoopVehicle + Send + Sync> Fleet<V> {
    /// Advances each vehicle that has a closed loop, as [`Simulation::advance_to`] does, bit for bit. For each index and vehicle, `order`
    /// returns the time to advance to, µs, and the inputs. The plants of vehicles with the same airframe step together, which
    /// [`Fleet::advance_each`] cannot do. A vehicle that cannot go on has failed.
    ///
    /// ```
    /// use quadrotor::{ClosedLoopVehicle, Configuration, Fleet, Inputs, Simulation};
    ///
    /// struct Courier {
    ///     simulation: Simulation,
    ///     inputs: Inputs,
    /// }
    ///
    /// impl ClosedLoopVehicle for Courier {
    ///     fn closed_loop(&self) -> Option<&Simulation> {
    ///         Some(&self.simulation)
    ///     }
    ///
    ///     fn closed_loop_mut(&mut self) -> Option<&mut Simulation> {
    ///         Some(&mut self.simulation)
    ///     }
    /// }
    ///
    /// # if !cfg!(feature = "shaper") { return Ok(()); }
    /// let inputs = Inputs::default();
    /// let simulation = Simulation::new(&Configuration::default(), &inputs)?;
    /// let couriers = (0..8).map(|_| Courier { simulation: simulation.clone(), inputs }).collect();
    /// let mut fleet = Fleet::of(couriers, None)?;
    /// // Each half a second on from where it is.
    /// fleet.advance_side_by_side(|_, courier| (courier.simulation.time_us() + 500_000, courier.inputs));
    /// assert!(fleet.vehicles().all(|courier| courier.simulation.outputs().position_m.z < 0.0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn advance_side_by_side<S: InputSignal>(&mut self, order: impl Fn(usize, &V) -> (u64, S) + Sync) {
        let flying = self.members.iter_mut().enumerate().filter(|(_, member)| member.failure.is_none());
        let mut flying: Vec<_> = flying
            .filter_map(|(index, member)| {
                Some((member.vehicle.closed_loop()?.plant().likeness(), index, member))
            })
            .collect();
        flying.sort_unstable_by_key(|(likeness, index, _)| (*likeness, *index));
        let fly = |side_by_side: &mut [(u64, usize, &mut Member<V>)]| {
            let flights = side_by_side.iter_mut().filter_map(|(_, index, member)| {
                let Member { vehicle, failure } = &mut **member;
                let order = order(*index, vehicle);
                Some(LaneFlight::new(vehicle.closed_loop_mut()?, failure, order))
            });
            advance_lanes(&mut flights.collect::<Vec<_>>());
        };
        self.threads.install(|| {
            flying
                .par_chunk_by_mut(|(likeness, _, member), (other_likeness, _, other)| {
                    let [plant, other] =
                        [member, other].map(|member| member.vehicle.closed_loop().map(Simulation::plant));
                    likeness == other_likeness && plant == other
                })
                .for_each(|of_one_plant| of_one_plant.par_chunks_mut(LANES).for_each(fly));
        });
    }
}

impl Fleet {
    /// Flights at time zero, one for each configuration, under these inputs by index. Vehicles that are alike share a design. There is
    /// a thread for each core.
    ///
    /// # Errors
    /// [`FleetError`].
    pub fn new(
        configurations: &[Configuration],
        inputs: impl Fn(usize) -> Inputs + Sync,
    ) -> Result<Self, FleetError> {
        Self::with_threads(configurations, inputs, None)
    }

    /// The same on so many threads.
    ///
    /// # Errors
    /// [`FleetError`].
    pub fn with_threads(
        configurations: &[Configuration],
        inputs: impl Fn(usize) -> Inputs + Sync,
        threads: Option<NonZeroUsize>,
    ) -> Result<Self, FleetError> {
        let threads = pool(threads)?;
        let refused = |vehicle: usize| move |error| FleetError::Configuration { vehicle, error };
        let kinds = Kinds::of(configurations, Configuration::fingerprint, is_same);
        let members = threads.install(|| {
            let designs = designs(kinds.first.iter().map(|vehicle| &configurations[*vehicle]).collect())
                .map_err(|(kind, error)| refused(kinds.first[kind])(error))?;
            let member = |(vehicle, kind): (usize, &usize)| {
                let simulation = Simulation::prepared(&designs[*kind], &inputs(vehicle));
                Ok(Member { vehicle: simulation.map_err(refused(vehicle))?, failure: None })
            };
            kinds.of_each.par_iter().enumerate().map(member).collect::<Result<Vec<_>, _>>()
        })?;
        Ok(Self { members, threads })
    }

    /// Flies all vehicles on to `time_us` under inputs by index, as [`Simulation::advance_to`] does. [`Fleet::failures`] tells which could
    /// not.
    pub fn advance_to<S: InputSignal>(&mut self, time_us: u64, inputs: impl Fn(usize) -> S + Sync) {
        self.advance_side_by_side(|index, _| (time_us, inputs(index)));
    }

    /// What can be observed of each vehicle now.
    pub fn outputs(&self) -> Vec<Outputs> {
        self.map(|_, simulation| simulation.outputs())
    }
}

/// The designs of configurations, or the index of one that is refused. Vehicles of a fleet mostly differ in little, so the others take over
/// from the first one what they can.
fn designs(configurations: Vec<&Configuration>) -> Result<Vec<PreparedDesign>, (usize, ConfigurationError)> {
    let Some((first, others)) = configurations.split_first() else { return Ok(Vec::new()) };
    let first = PreparedDesign::new(first).map_err(|error| (0, error))?;
    let adapted = others
        .par_iter()
        .enumerate()
        .map(|(index, configuration)| first.adapted(configuration).map_err(|error| (index + 1, error)));
    let mut designs = adapted.collect::<Result<Vec<_>, _>>()?;
    designs.insert(0, first);
    Ok(designs)
}

fn pool(threads: Option<NonZeroUsize>) -> Result<ThreadPool, FleetError> {
    ThreadPoolBuilder::new()
        .num_threads(threads.map_or(0, NonZeroUsize::get))
        .thread_name(|thread| format!("fleet {thread}"))
        .build()
        .map_err(|error| FleetError::Threads { reason: error.to_string() })
}

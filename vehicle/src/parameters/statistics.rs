//! What a vehicle counts over its boots: ArduPilot's STAT parameters.

/// Seconds from 1970 to 2016, where STAT_RESET counts from.
const RESET_EPOCH_S: u64 = 1_451_606_400;

/// Counts since they were reset. A reboot keeps them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Statistics {
    /// How often the vehicle has booted.
    pub boots: u32,
    /// How often it has taken off.
    pub flights: u32,
    /// Time in the air, µs.
    pub flight_us: u64,
    /// Time that it was switched on, µs.
    pub run_us: u64,
    /// When the counts were reset, s since 1970.
    pub reset_unix_s: u64,
    /// Items of mission, fence and rally plan.
    pub items: [u32; 3],
}

/// One of the counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Statistic {
    /// How often the vehicle has booted.
    Boots,
    /// How often it has taken off.
    Flights,
    /// Time in the air, s.
    FlightTime,
    /// Time that it was switched on, s.
    RunTime,
    /// When the counts were reset, s since 2016; setting it to 0 resets them.
    Reset,
    /// Items of the mission.
    MissionItems,
    /// Items of the fence.
    FenceItems,
    /// Rally points.
    RallyPoints,
}

impl Statistic {
    /// All of them with their names.
    pub const ALL: [(&'static str, Self); 8] = [
        ("FENCE_TOTAL", Self::FenceItems),
        ("MIS_TOTAL", Self::MissionItems),
        ("RALLY_TOTAL", Self::RallyPoints),
        ("STAT_BOOTCNT", Self::Boots),
        ("STAT_FLTCNT", Self::Flights),
        ("STAT_FLTTIME", Self::FlightTime),
        ("STAT_RESET", Self::Reset),
        ("STAT_RUNTIME", Self::RunTime),
    ];

    /// What it means.
    pub fn text(self) -> &'static str {
        match self {
            Self::Boots => "Number of boots since the statistics were reset, or from the value that was set",
            Self::Flights => "Number of flights since the statistics were reset (read-only)",
            Self::FlightTime => "Time in the air since the statistics were reset (read-only)",
            Self::RunTime => "Time switched on since the statistics were reset (read-only)",
            Self::Reset => {
                "Time of the last reset of the statistics, in seconds since 2016; set it to 0 to reset them"
            }
            Self::MissionItems => "Number of mission items, home included (read-only)",
            Self::FenceItems => "Number of items of the fence (read-only)",
            Self::RallyPoints => "Number of rally points (read-only)",
        }
    }

    /// Its unit.
    pub fn unit(self) -> &'static str {
        match self {
            Self::FlightTime | Self::RunTime | Self::Reset => "s",
            Self::Boots | Self::Flights | Self::MissionItems | Self::FenceItems | Self::RallyPoints => "",
        }
    }

    /// The largest value that it can have.
    pub fn most(self) -> f64 {
        match self {
            Self::Boots => f64::from(u16::MAX),
            _ => f64::from(i32::MAX),
        }
    }

    /// What it may be set to.
    pub fn choices(self) -> &'static [(i32, &'static str)] {
        if self == Self::Reset { &[(0, "Reset all")] } else { &[] }
    }

    /// Its value.
    pub fn of(self, statistics: &Statistics) -> u64 {
        match self {
            Self::Boots => u64::from(statistics.boots),
            Self::Flights => u64::from(statistics.flights),
            Self::FlightTime => statistics.flight_us / 1_000_000,
            Self::RunTime => statistics.run_us / 1_000_000,
            Self::Reset => statistics.reset_unix_s.saturating_sub(RESET_EPOCH_S),
            Self::MissionItems => u64::from(statistics.items[0]),
            Self::FenceItems => u64::from(statistics.items[1]),
            Self::RallyPoints => u64::from(statistics.items[2]),
        }
    }
}

impl Statistics {
    /// Counts boots on from a number. Returns whether it is a valid count.
    pub fn set_boots(&mut self, boots: f64) -> bool {
        let is_count = boots.fract() == 0.0 && (0.0..=Statistic::Boots.most()).contains(&boots);
        if is_count {
            self.boots = boots as u32;
        }
        is_count
    }

    /// All counts from now, s since 1970.
    pub fn reset(&mut self, unix_s: u64) {
        *self = Self { boots: 1, reset_unix_s: unix_s, ..Self::default() };
    }
}

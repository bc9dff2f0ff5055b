//! Fuzz targets: what comes over links and out of files. The same seed makes the same case.

mod bytes;
mod files;
mod flight;
mod signatures;
mod simulator;

/// Something that is fed, and must not break.
pub struct FuzzTarget {
    pub name: &'static str,
    /// What is counted.
    unit: &'static str,
    one: fn(u64) -> u64,
}

pub const TARGETS: [FuzzTarget; 5] = [
    FuzzTarget { name: "vehicle", unit: "frames taken in", one: flight::anything },
    FuzzTarget { name: "garbage", unit: "flights undisturbed", one: flight::undisturbed },
    FuzzTarget { name: "signatures", unit: "frames refused", one: signatures::forged },
    FuzzTarget { name: "files", unit: "files read", one: files::changed },
    FuzzTarget { name: "simulator", unit: "controls taken in", one: simulator::controlled },
];

/// Tells how a case that failed is repeated.
struct Repeat(&'static str, u64);

impl Drop for Repeat {
    fn drop(&mut self) {
        let Self(name, seed) = self;
        if std::thread::panicking() {
            eprintln!("repeat it: cargo run -p sitl --example fuzz -- {name} --seed {seed} --cases 1");
        }
    }
}

impl FuzzTarget {
    /// Runs the case of a seed. Panics if something breaks. Returns how much of what is counted there was.
    fn case(&self, seed: u64) -> u64 {
        let _repeat = Repeat(self.name, seed);
        (self.one)(seed)
    }

    /// Runs cases from a seed on while wanted. Returns how much of what is counted there was, and the figures in words.
    pub fn run(&self, seed: u64, mut goes_on: impl FnMut(u64) -> bool) -> (u64, String) {
        let (mut cases, mut count) = (0, 0);
        while goes_on(cases) {
            count += self.case(seed.wrapping_add(cases));
            cases += 1;
        }
        (count, format!("{}: {cases} cases, {count} {}", self.name, self.unit))
    }
}

//! The browser that tests of the live page drive.

use crate::progress::Progress;
use crate::python::Packages;
use crate::toolchains::{Need, provide};
use xtask::failure::Failure;
use xtask::workspace::Workspace;

/// Whether the live page is tested.
#[derive(Debug, PartialEq)]
pub enum Browser {
    /// There is a browser.
    Found,
    /// There is none, and none can be had.
    Missing {
        /// Why, and what to type.
        reason: String,
    },
    /// Nobody wants it.
    LeftOut,
}

impl Browser {
    /// Finds one. Installs one where that can be done, unless it is not wanted.
    pub fn provide(workspace: &Workspace, progress: &Progress, wanted: bool) -> Self {
        if !wanted {
            return Self::LeftOut;
        }
        if Need::Chromium.is_met() {
            return Self::Found;
        }
        // The other tests do not need it: they run whatever comes of this.
        Self::after(provide(workspace, progress, vec![Need::Chromium], true), Need::Chromium.is_met())
    }

    /// What an installation has led to.
    fn after(installed: Result<(), Failure>, is_there: bool) -> Self {
        let remedy = Need::Chromium.remedy();
        match installed {
            Ok(()) if is_there => Self::Found,
            // Where packages cannot be installed the failure is the remedy.
            Ok(()) | Err(Failure::Needs { .. }) => Self::Missing { reason: format!("they need {remedy}") },
            Err(failure) => {
                Self::Missing { reason: format!("they need {remedy}; installing it failed: {failure}") }
            }
        }
    }

    /// Packages of the tests.
    pub fn packages(&self) -> Packages {
        match self {
            Self::Found => Packages::BrowserTests,
            Self::Missing { .. } | Self::LeftOut => Packages::Tests,
        }
    }

    /// What is said at the end.
    pub fn note(&self) -> Option<String> {
        match self {
            Self::Found => None,
            Self::Missing { reason } => Some(format!("the tests of the live page were skipped: {reason}")),
            Self::LeftOut => Some("the tests of the live page were skipped, as asked".to_owned()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Browser, Failure};

    #[test]
    fn whoever_has_no_browser_is_told_why_and_what_to_type() {
        assert_eq!(Browser::after(Ok(()), true), Browser::Found);
        assert_eq!(Browser::Found.note(), None);
        for failure in [Failure::Needs { needs: String::new() }, Failure::Packages] {
            let note = Browser::after(Err(failure), false).note().expect("something to say");
            assert!(note.contains("skipped") && note.contains("apt-get install chromium"), "{note}");
        }
        assert!(Browser::LeftOut.note().expect("something to say").contains("as asked"));
    }
}

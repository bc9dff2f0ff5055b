//! Where things lie in the repository and below its target folder.

use std::path::{Path, PathBuf};

use crate::cargo;
use crate::failure::Failure;

/// The repository.
pub struct Workspace {
    root: PathBuf,
    target: PathBuf,
}

impl Workspace {
    /// Asks cargo, which knows of every way to move the target folder.
    ///
    /// # Errors
    ///
    /// If cargo does not start or does not find the workspace.
    pub fn find() -> Result<Self, Failure> {
        let metadata = cargo::metadata_without_dependencies()?;
        Ok(Self { root: metadata.workspace_root, target: metadata.target_directory })
    }

    /// Root of the repository.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// The description that the repository holds.
    pub fn model_description(&self) -> PathBuf {
        self.root.join("modelDescription.xml")
    }

    /// Template of the documentation, icon.
    pub fn fmu_assets(&self) -> PathBuf {
        self.root.join("fmu").join("assets")
    }

    /// Scripts and requirements of the demo.
    pub fn python_sources(&self) -> PathBuf {
        self.root.join("xtask").join("python")
    }

    /// Tests in Python.
    pub fn python_tests(&self) -> PathBuf {
        self.root.join("tests").join("python")
    }

    /// The folder of the FMUs that are built.
    pub fn fmus(&self) -> PathBuf {
        self.target.join("fmu")
    }

    /// The FMU of the closed loop.
    pub fn fmu(&self) -> PathBuf {
        self.fmus().join("LmpcQuadrotor.fmu")
    }

    /// What the demo writes.
    pub fn demo(&self) -> PathBuf {
        self.target.join("demo")
    }

    /// The paper's results.
    pub fn paper(&self) -> PathBuf {
        self.target.join("paper")
    }

    /// A program of the workspace that `cargo build` makes.
    pub fn program(&self, name: &str) -> PathBuf {
        self.target.join("debug").join(format!("{name}{}", std::env::consts::EXE_SUFFIX))
    }

    /// The examples that `cargo test` builds.
    pub fn examples(&self) -> PathBuf {
        self.target.join("debug").join("examples")
    }

    /// What is built for any machine of a platform, and what that takes.
    pub fn platforms(&self) -> PathBuf {
        self.target.join("platforms")
    }

    /// The vehicle's programs for other machines, a folder for each platform.
    pub fn vehicles(&self) -> PathBuf {
        self.target.join("sitl")
    }

    /// What is attached to a release.
    pub fn assets(&self) -> PathBuf {
        self.target.join("assets")
    }

    /// Sources of the Python package.
    pub fn python_package(&self) -> PathBuf {
        self.root.join("python")
    }

    /// The wheels that are built to be shipped.
    pub fn wheels(&self) -> PathBuf {
        self.target.join("wheels")
    }

    /// Tests of the installed Python package.
    pub fn package_tests(&self) -> PathBuf {
        self.python_tests().join("package")
    }

    /// Report of the tests of the Python package.
    pub fn package_report(&self) -> PathBuf {
        self.target.join("package-tests.xml")
    }

    /// A file or folder below the target folder.
    pub fn target(&self, name: &str) -> PathBuf {
        self.target.join(name)
    }

    /// The benchmark's sources and kept results.
    pub fn bench(&self) -> PathBuf {
        self.root.join("bench")
    }

    /// Sources of the book.
    pub fn book(&self) -> PathBuf {
        self.root.join("book")
    }

    /// Report of the Python tests.
    pub fn python_report(&self) -> PathBuf {
        self.target.join("python-tests.xml")
    }

    /// A path as a person at the root of the repository would write it.
    pub fn shown(&self, path: &Path) -> String {
        path.strip_prefix(&self.root).unwrap_or(path).display().to_string()
    }
}

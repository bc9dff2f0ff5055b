//! Packs the files of the page once, as browsers take them: the program has them as gzip alone.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use flate2::Compression;
use flate2::write::GzEncoder;

fn main() -> io::Result<()> {
    let folder =
        |variable: &str| std::env::var_os(variable).map(PathBuf::from).ok_or(io::ErrorKind::NotFound);
    let assets = folder("CARGO_MANIFEST_DIR")?.join("assets");
    println!("cargo::rerun-if-changed={}", assets.display());
    pack(&assets, &folder("OUT_DIR")?)
}

/// Packs each file below a folder into one of its name and `.gz`.
fn pack(from: &Path, to: &Path) -> io::Result<()> {
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from)? {
        let entry = entry?;
        let mut name = entry.file_name();
        if entry.file_type()?.is_dir() {
            pack(&entry.path(), &to.join(name))?;
        } else {
            name.push(".gz");
            let mut encoder = GzEncoder::new(fs::File::create(to.join(name))?, Compression::best());
            encoder.write_all(&fs::read(entry.path())?)?;
            encoder.finish()?;
        }
    }
    Ok(())
}

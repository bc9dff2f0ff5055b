//! The files of the page, within the program.

use std::io::Read;

use flate2::read::GzDecoder;

/// A file.
#[derive(Clone, Copy, Debug)]
pub struct Asset {
    /// Path in the address.
    pub path: &'static str,
    /// What browsers are told it is.
    pub content_type: &'static str,
    /// Its bytes, packed with gzip: what browsers take.
    pub packed: &'static [u8],
}

impl Asset {
    /// Its bytes.
    pub fn content(&self) -> Vec<u8> {
        let mut content = Vec::new();
        // What the build has packed can be unpacked: a test unpacks all of it.
        let _whole = GzDecoder::new(self.packed).read_to_end(&mut content);
        content
    }

    /// Its bytes as text.
    pub fn text(&self) -> String {
        String::from_utf8_lossy(&self.content()).into_owned()
    }
}

const HTML: &str = "text/html; charset=utf-8";
const CSS: &str = "text/css; charset=utf-8";
pub const SCRIPT: &str = "text/javascript; charset=utf-8";
const PLAIN: &str = "text/plain; charset=utf-8";
const SVG: &str = "image/svg+xml";

macro_rules! file {
    ($path:literal, $content_type:expr) => {
        Asset {
            path: concat!("/", $path),
            content_type: $content_type,
            packed: include_bytes!(concat!(env!("OUT_DIR"), "/", $path, ".gz")),
        }
    };
}

/// All of them.
pub static ASSETS: &[Asset] = &[
    file!("page/index.html", HTML),
    file!("page/style.css", CSS),
    file!("page/icon.svg", SVG),
    file!("page/main.js", SCRIPT),
    file!("page/stream.js", SCRIPT),
    file!("page/frame.js", SCRIPT),
    file!("page/scene.js", SCRIPT),
    file!("page/axes.js", SCRIPT),
    file!("page/airframe.js", SCRIPT),
    file!("page/crafts.js", SCRIPT),
    file!("page/trail.js", SCRIPT),
    file!("page/grid.js", SCRIPT),
    file!("page/graphics.js", SCRIPT),
    file!("page/labels.js", SCRIPT),
    file!("page/redraw.js", SCRIPT),
    file!("page/rarely.js", SCRIPT),
    file!("page/ground.js", SCRIPT),
    file!("page/surroundings.js", SCRIPT),
    file!("page/horizon.js", SCRIPT),
    file!("page/plots.js", SCRIPT),
    file!("page/history.js", SCRIPT),
    file!("page/panel.js", SCRIPT),
    file!("page/controls.js", SCRIPT),
    file!("page/replay.js", SCRIPT),
    file!("page/film.js", SCRIPT),
    file!("page/ulog.js", SCRIPT),
    file!("page/csv.js", SCRIPT),
    file!("three/three.module.min.js", SCRIPT),
    file!("three/three.core.min.js", SCRIPT),
    file!("three/OrbitControls.js", SCRIPT),
    file!("three/LICENSE", PLAIN),
    file!("uplot/uPlot.esm.js", SCRIPT),
    file!("uplot/uPlot.min.css", CSS),
];

/// The file of a path; `/` is the page.
pub fn asset(path: &str) -> Option<&'static Asset> {
    let path = if path == "/" { "/page/index.html" } else { path };
    ASSETS.iter().find(|asset| asset.path == path)
}

#[cfg(test)]
mod tests {
    use super::{ASSETS, SCRIPT, asset};

    #[test]
    fn every_file_that_one_of_them_imports_is_there() {
        for script in ASSETS.iter().filter(|asset| asset.content_type == SCRIPT) {
            let text = script.text();
            let folder = script.path.rsplit_once('/').expect("a folder").0;
            for import in text.split("from \"").skip(1).filter_map(|rest| rest.split('"').next()) {
                let path = match import.strip_prefix("../") {
                    Some(path) => format!("/{path}"),
                    None => format!("{folder}/{}", import.trim_start_matches("./")),
                };
                let is_path = import.starts_with('.') || import.starts_with('/');
                assert!(!is_path || asset(&path).is_some(), "{} imports {import}", script.path);
            }
        }
    }

    #[test]
    fn every_file_is_the_one_that_was_packed() {
        for file in ASSETS {
            let original = concat!(env!("CARGO_MANIFEST_DIR"), "/assets").to_owned() + file.path;
            assert_eq!(file.content(), std::fs::read(original).expect("is there"), "{}", file.path);
        }
    }

    #[test]
    fn the_page_asks_for_nothing_from_elsewhere() {
        for file in ASSETS.iter().filter(|file| file.path.starts_with("/page/")) {
            let text = file.text();
            for line in
                text.lines().filter(|line| line.contains("//") && !line.contains("www.w3.org/2000/svg"))
            {
                assert!(!line.contains("http://") && !line.contains("https://"), "{}: {line}", file.path);
            }
        }
        assert!(asset("/").is_some_and(|page| page.path == "/page/index.html"));
        assert!(asset("/../Cargo.toml").is_none() && asset("/page/").is_none());
    }
}

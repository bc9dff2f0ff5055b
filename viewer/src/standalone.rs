//! The page with a recording as one file, which browsers open from a disk.
//!
//! Browsers load no module from a disk. So each module is an address with its own content (`data:`), and a map leads to it from a
//! name: the path without its first slash.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use crate::assets::{ASSETS, Asset, SCRIPT, asset};
use crate::recording::Recording;

/// What the page asks its server for, and what stands in its place here.
const HEAD: [&str; 4] = [
    "<link rel=\"icon\" href=\"/page/icon.svg\" type=\"image/svg+xml\">\n",
    "<link rel=\"stylesheet\" href=\"/uplot/uPlot.min.css\">\n",
    "<link rel=\"stylesheet\" href=\"/page/style.css\">\n",
    "<script type=\"module\" src=\"/page/main.js\"></script>\n",
];
/// Nothing comes from elsewhere, and nothing goes there.
const POLICY: &str = "default-src 'none'; script-src 'unsafe-inline' data:; style-src 'unsafe-inline'; img-src data:; \
                      base-uri 'none'; form-action 'none'";
/// How scripts name the modules that they import.
const IMPORTS: [(&str, char); 3] = [("from \"", '"'), ("from\"", '"'), ("from '", '\'')];

/// The page as one file of HTML.
pub fn standalone(recording: &Recording) -> String {
    let [icon, plots, page, script] = HEAD;
    let style = |path| format!("<style>\n{}</style>\n", text_of(path));
    let modules: serde_json::Map<String, serde_json::Value> = ASSETS
        .iter()
        .filter(|asset| asset.content_type == SCRIPT)
        .map(|asset| (name_of(asset.path).to_owned(), address_of(asset).into()))
        .collect();
    let map = serde_json::json!({ "imports": modules });
    let head = format!(
        "<meta http-equiv=\"Content-Security-Policy\" content=\"{POLICY}\">\n\
         <script type=\"importmap\">{map}</script>\n\
         <script type=\"application/octet-stream\" id=\"recording\" data-name=\"{}\">{}</script>\n\
         <script type=\"module\">import \"page/main.js\";</script>\n",
        escaped(recording.name()),
        STANDARD.encode(recording.content()),
    );
    let title = format!("<title>{}</title>", escaped(recording.name()));
    text_of("/page/index.html")
        .replace("<title>LMPC quadrotor</title>", &title)
        .replace(icon, "")
        .replace(plots, &style("/uplot/uPlot.min.css"))
        .replace(page, &style("/page/style.css"))
        .replace(script, &head)
}

fn text_of(path: &str) -> String {
    asset(path).map(Asset::text).unwrap_or_default()
}

/// Name of a module.
fn name_of(path: &str) -> &str {
    path.trim_start_matches('/')
}

/// An address that has a script in it.
fn address_of(script: &Asset) -> String {
    let folder = script.path.rsplit_once('/').map_or("", |(folder, _)| folder);
    let named =
        IMPORTS.iter().fold(script.text(), |text, (before, quote)| named(&text, before, *quote, folder));
    format!("data:text/javascript;base64,{}", STANDARD.encode(named))
}

/// A script that imports modules by their names instead of by their paths.
fn named(text: &str, before: &str, quote: char, folder: &str) -> String {
    let mut pieces = text.split(before);
    let mut whole = pieces.next().unwrap_or_default().to_owned();
    for piece in pieces {
        let path = piece.split(quote).next().unwrap_or_default();
        let name = match (path.strip_prefix("./"), path.strip_prefix("../")) {
            (Some(beside), _) => format!("{}/{beside}", name_of(folder)),
            (None, Some(above)) => above.to_owned(),
            (None, None) => path.to_owned(),
        };
        whole.push_str(before);
        whole.push_str(&name);
        whole.push_str(piece.strip_prefix(path).unwrap_or_default());
    }
    whole
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::{HEAD, Recording, STANDARD, address_of, standalone, text_of};
    use crate::assets::{ASSETS, SCRIPT};
    use base64::Engine;

    #[test]
    fn the_page_has_all_in_it_and_asks_for_nothing() {
        let page = text_of("/page/index.html");
        assert!(HEAD.iter().all(|line| page.contains(line)), "the page asks for something else");
        let whole = standalone(&Recording::new("a<b.csv".to_owned(), b"time\n".to_vec()));
        let asked = ["src=\"/", "href=\"/", "http://", "https://"];
        assert!(!asked.iter().any(|word| whole.contains(word)));
        assert!(whole.contains("data-name=\"a&lt;b.csv\">dGltZQo=</script>"));
        assert!(whole.contains("<title>a&lt;b.csv</title>"));
    }

    #[test]
    fn each_module_imports_others_by_names_that_there_are() {
        let names: Vec<&str> = ASSETS.iter().map(|asset| super::name_of(asset.path)).collect();
        let mut imports = 0;
        for script in ASSETS.iter().filter(|asset| asset.content_type == SCRIPT) {
            let address = address_of(script);
            let (_, content) = address.split_once("base64,").expect("an address");
            let text = String::from_utf8(STANDARD.decode(content).expect("base64")).expect("text");
            for line in
                text.split(['\n', ';']).filter(|line| line.contains("import") || line.contains("export"))
            {
                for name in names.iter().filter(|name| line.contains(&format!("\"{name}\""))) {
                    imports += 1;
                    assert!(name.ends_with(".js"), "{}: {name}", script.path);
                }
            }
            for path in ["from \"./", "from \"../", "from\"./", "from './"] {
                assert!(!text.contains(path), "{}: {path}", script.path);
            }
        }
        assert!(imports > 20, "{imports}");
    }
}

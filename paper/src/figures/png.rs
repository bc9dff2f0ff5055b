//! PNG copies of figures.

use std::sync::Arc;

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree, fontdb};

use crate::error::Error;

/// Pixels of the copy per pixel of the figure.
const ZOOM: f32 = 1.5;

/// Renders an SVG with a font that comes along: the machine may have none.
///
/// # Errors
/// [`Error::Picture`].
pub fn png(name: &str, svg: &str) -> Result<Vec<u8>, Error> {
    let failed = |reason: String| Error::Picture { name: name.to_owned(), reason };
    let mut fonts = fontdb::Database::new();
    fonts.load_font_data(ttf_noto_sans::REGULAR.to_vec());
    let options =
        Options { fontdb: Arc::new(fonts), font_family: "Noto Sans".to_owned(), ..Options::default() };
    let tree = Tree::from_str(svg, &options).map_err(|error| failed(error.to_string()))?;
    let size = tree.size();
    let pixels = |length: f32| (length * ZOOM).ceil() as u32;
    let mut canvas = Pixmap::new(pixels(size.width()), pixels(size.height()))
        .ok_or_else(|| failed("it is empty".to_owned()))?;
    resvg::render(&tree, Transform::from_scale(ZOOM, ZOOM), &mut canvas.as_mut());
    canvas.encode_png().map_err(|error| failed(error.to_string()))
}

#[cfg(test)]
mod tests {
    use super::png;

    #[test]
    fn text_is_drawn() {
        let picture = |text: &str| {
            let svg = format!(
                "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"80\" height=\"20\"><text y=\"15\" \
                 font-family=\"'Noto Sans',sans-serif\">{text}</text></svg>"
            );
            png("test", &svg).unwrap()
        };
        let (empty, one, other) = (picture(""), picture("α"), picture("β"));
        assert!(empty != one && one != other);
        assert!(png("test", "<svg").unwrap_err().to_string().starts_with("test: "));
    }
}

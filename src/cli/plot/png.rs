//! The SVG as pixels, drawn by resvg with a font of the program's own: the same on every machine.

use std::sync::Arc;

use resvg::{tiny_skia, usvg};

use crate::error::Fault;

/// A PNG of `width` pixels, as high as the picture's shape asks.
///
/// # Errors
/// What the drawing library says.
pub fn of(svg: &str, width: u32) -> Result<Vec<u8>, Fault> {
    let failed = |reason: String| Fault::unusable("PNG", reason);
    let mut fonts = usvg::fontdb::Database::new();
    fonts.load_font_data(dejavu::sans::regular().to_vec());
    fonts.set_sans_serif_family("DejaVu Sans");
    let options = usvg::Options { fontdb: Arc::new(fonts), ..usvg::Options::default() };
    let tree = usvg::Tree::from_str(svg, &options).map_err(|e| failed(e.to_string()))?;
    let scale = width as f32 / tree.size().width();
    let height = (tree.size().height() * scale).round() as u32;
    let mut pixels = tiny_skia::Pixmap::new(width, height)
        .ok_or_else(|| failed(format!("{width} x {height} pixels cannot be had")))?;
    resvg::render(&tree, tiny_skia::Transform::from_scale(scale, scale), &mut pixels.as_mut());
    pixels.encode_png().map_err(|e| failed(e.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_are_drawn_and_the_size_is_what_was_asked_for() {
        let svg = |text: &str| {
            format!(
                "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"40\" height=\"20\">\
                 <text x=\"5\" y=\"15\" font-family=\"sans-serif\" font-size=\"12\">{text}</text></svg>"
            )
        };
        let (written, empty) = (of(&svg("µm/s"), 80).unwrap(), of(&svg(""), 80).unwrap());
        // PNG specification: width and height stand big-endian from byte 16 on.
        assert_eq!(written[16..24], [0, 0, 0, 80, 0, 0, 0, 40]);
        assert!(written.len() > empty.len() + 50, "the font is missing");
    }
}

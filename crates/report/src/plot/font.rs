//! The letters of plots: a font that is a part of the program, as a server may have none.

use std::sync::OnceLock;

use plotters::style::{FontStyle, register_font};

/// Makes the font known, once. Without it no text can be measured, and drawing says so.
pub fn ready() {
    static READY: OnceLock<()> = OnceLock::new();
    READY.get_or_init(|| {
        // DejaVu Sans is a font: the only fault that this can have does not happen.
        let _ = register_font("sans-serif", FontStyle::Normal, dejavu::sans::regular());
    });
}

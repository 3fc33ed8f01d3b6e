//! The font of plots: a part of the program, because a server may have none.

use std::sync::OnceLock;

use plotters::style::{FontStyle, register_font};

/// Registers the font, once. Without it, drawing text is an error.
pub(super) fn register() {
    static REGISTERED: OnceLock<()> = OnceLock::new();
    REGISTERED.get_or_init(|| {
        // The only error is that of an invalid font.
        let _ = register_font("sans-serif", FontStyle::Normal, dejavu::sans::regular());
    });
}

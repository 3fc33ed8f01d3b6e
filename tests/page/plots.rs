//! The plots of the page beside those in `pictures/`, which `UPDATE=1` writes anew, to be looked at again.

use std::fs;
use std::path::Path;
use std::time::Duration;

use serde_json::Value;

use crate::browser::{Browser, PATIENCE};
use crate::common::pictures::other_lines;

const FOLDER: &str = "tests/page/pictures";
/// How far a part of a plot may be from its reference, pixels: names of curves are as wide as the fonts of the machine.
const SHIFT: f64 = 6.0;
/// The plots in sight without their cursors: their names, and themselves. That of the accuracy shows how long this
/// machine took.
const PLOTS: &str = "[...document.querySelectorAll('.plot:not(#plot-accuracy)')].filter((plot) => plot.offsetParent) \
                     .map((plot) => { \
                     const copy = plot.querySelector('svg.chart').cloneNode(true); \
                     copy.querySelector('.cursor')?.remove(); \
                     return [plot.id, copy.outerHTML.replaceAll('><', '>\\n<')]; })";
/// Between two looks at plots that are still being drawn.
const PAUSE: Duration = Duration::from_millis(200);

/// The plots once they stay as they are.
async fn settled(browser: &Browser) -> Vec<(String, String)> {
    let mut before = Value::Null;
    loop {
        let now = browser.value(PLOTS).await;
        if now == before {
            return serde_json::from_value(now).unwrap();
        }
        before = now;
        tokio::time::sleep(PAUSE).await;
    }
}

/// Asserts that the plots in sight are those that were looked at.
pub async fn assert_looked_at(browser: &Browser, view: &str) {
    let file = |name: &str| Path::new(FOLDER).join(format!("{view}-{}.svg", name.trim_start_matches("plot-")));
    if std::env::var_os("UPDATE").is_some() {
        fs::create_dir_all(FOLDER).unwrap();
        for (name, plot) in settled(browser).await {
            fs::write(file(&name), plot).unwrap();
        }
    }
    let other = async || {
        settled(browser).await.into_iter().find_map(|(name, plot)| {
            let reference = fs::read_to_string(file(&name)).unwrap_or_default();
            other_lines(&plot, &reference, SHIFT).map(|other| format!("{view}, {name}: {other}"))
        })
    };
    let alike = async { while other().await.is_some() {} };
    if tokio::time::timeout(PATIENCE, alike).await.is_err() {
        panic!("another picture than the one that was looked at: {}", other().await.unwrap_or_default());
    }
}

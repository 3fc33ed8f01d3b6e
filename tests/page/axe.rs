//! axe-core from npm, at the version of `package-lock.json`: rules of accessibility, run in the page.

use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::OnceLock;

use serde_json::Value;

use crate::browser::{self, Browser};
use crate::plots;

/// The script, installed as `./check` does it if this version is not there yet.
fn script() -> &'static str {
    static SCRIPT: OnceLock<String> = OnceLock::new();
    SCRIPT.get_or_init(|| {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let (lock, done) = (root.join("package-lock.json"), root.join("node_modules/installed.json"));
        let read = |file: &Path| std::fs::read(file).ok();
        if read(&done) != read(&lock) {
            let mut npm = Command::new("npm");
            npm.args(["ci", "--no-audit", "--no-fund", "--ignore-scripts"]);
            let status = npm.current_dir(root).stdout(Stdio::null()).status();
            assert!(status.expect("this test needs npm: see https://nodejs.org").success());
            std::fs::copy(lock, done).unwrap();
        }
        std::fs::read_to_string(root.join("node_modules/axe-core/axe.min.js")).unwrap()
    })
}

/// What the rules find that is serious or critical in the page as it is now, a line each.
pub async fn serious(browser: &Browser) -> Vec<String> {
    browser.page.execute(script(), vec![]).await.unwrap();
    let run =
        "const done = arguments[arguments.length - 1]; axe.run(document, { resultTypes: ['violations'] }).then(done);";
    let found: Value = browser.page.execute_async(run, vec![]).await.unwrap();
    assert!(found["passes"].as_array().unwrap().len() > 10, "the rules ran: {found}");
    let severe =
        |violation: &&Value| ["serious", "critical"].contains(&violation["impact"].as_str().unwrap_or_default());
    let line = |violation: &Value| {
        let places = violation["nodes"].as_array().unwrap().iter();
        let places: Vec<_> = places.map(|node| format!("{} {}", node["target"], node["any"][0]["message"])).collect();
        format!("{}: {}\n  {}", violation["id"], violation["help"], places.join("\n  "))
    };
    found["violations"].as_array().unwrap().iter().filter(severe).map(line).collect()
}

/// Asserts that the page with its results has no serious fault, fits the window and shows the chosen tab, on a phone in
/// the dark, a tablet and a desk, which is the window afterwards, and that its plots are those that were looked at;
/// saves a picture of each in both colour schemes.
pub async fn assert_readable(browser: &Browser, name: &str) {
    for (look, width, height, dark) in
        [("narrow-dark-", 390, 844, true), ("tablet-", 768, 1024, false), ("", 1440, 900, false)]
    {
        browser.look(width, height, dark).await;
        browser.until("document.documentElement.scrollWidth <= innerWidth").await;
        // Results of before are pale until those of now are there.
        browser.until("document.querySelector('.stale') === null").await;
        let tab = "document.querySelector('.tabs [aria-current]')";
        let strip = "document.querySelector('.tabs')";
        let within = |side: &str, order: &str| {
            format!("{tab}.getBoundingClientRect().{side} {order} {strip}.getBoundingClientRect().{side}")
        };
        let shown = format!("{tab} === null || ({} && {})", within("left", ">="), within("right", "<="));
        browser.until(&shown).await;
        assert_eq!(serious(browser).await, [""; 0], "{look}{name}");
        let whole = browser.value("document.documentElement.scrollHeight").await.as_u64().unwrap();
        let whole = u32::try_from(whole).unwrap();
        if browser::takes_pictures() {
            browser.look(width, whole, !dark).await;
            browser.picture(&format!("other-{look}{name}")).await;
        }
        browser.look(width, whole, dark).await;
        browser.picture(&format!("{look}{name}")).await;
        browser.look(width, height, dark).await;
    }
    plots::assert_looked_at(browser, name).await;
}

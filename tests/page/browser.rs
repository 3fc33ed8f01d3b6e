//! Chromium without a window, driven over WebDriver.

use std::io::{BufRead as _, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use fantoccini::actions::{InputSource as _, MOUSE_BUTTON_LEFT, MouseActions, PointerAction};
use fantoccini::elements::Element;
use fantoccini::{Client, ClientBuilder, Locator};
use hyper_util::client::legacy::connect::HttpConnector;
use serde_json::{Value, json};
use tempfile::TempDir;

/// The variable that names a folder for screenshots.
const SCREENSHOTS: &str = "PAGE_SCREENSHOTS";
/// The variable that names the browser, in place of the Chromium that the driver finds.
const BROWSER: &str = "PAGE_BROWSER";
/// How long to wait for something to appear: only a hang takes longer.
pub const PATIENCE: Duration = Duration::from_secs(30);

/// Whether pictures of the page are saved.
pub fn takes_pictures() -> bool {
    std::env::var_os(SCREENSHOTS).is_some()
}

/// A browser; it ends when it is dropped.
pub struct Browser {
    driver: Child,
    /// For the temporary files, which a browser that is killed leaves behind.
    _folder: TempDir,
    /// The WebDriver session, as an address.
    session: String,
    pub page: Client,
    http: reqwest::Client,
}

/// A driver with its temporary files in a folder, and its port. It looks for a free port on IPv6 and then takes the
/// same on IPv4, where it may be in use; then the driver ends, and another one is started.
fn driver(folder: &Path) -> (Child, String) {
    let started = (0..10).find_map(|_| {
        let mut driver = Command::new("chromedriver")
            .arg("--port=0")
            .env("TMPDIR", folder)
            .stdout(Stdio::piped())
            .spawn()
            .expect("./check installs chromium and chromedriver");
        let mut lines = BufReader::new(driver.stdout.take().unwrap()).lines().map_while(Result::ok);
        let port = lines.find_map(|line| {
            line.strip_prefix("ChromeDriver was started successfully on port ")
                .map(|port| port.trim_end_matches('.').to_owned())
        });
        if port.is_none() {
            driver.wait().unwrap();
        }
        port.map(|port| (driver, port))
    });
    started.expect("chromedriver finds a port in one of ten times")
}

impl Browser {
    /// Starts one with a window of so many pixels.
    pub async fn start(width: u32, height: u32, dark: bool) -> Browser {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().to_owned();
        let (driver, port) = tokio::task::spawn_blocking(move || driver(&path)).await.unwrap();
        let address = format!("http://127.0.0.1:{port}");
        // Without a sandbox, because tests in containers run as root; it sees no page but ours.
        let mut options =
            json!({"args": ["--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--disable-gpu"]});
        if let Ok(browser) = std::env::var(BROWSER) {
            options["binary"] = json!(browser);
        }
        let wanted = json!({
            "browserName": "chrome",
            "goog:chromeOptions": options,
            "goog:loggingPrefs": {"browser": "ALL", "performance": "ALL"},
        });
        let mut builder = ClientBuilder::new(HttpConnector::new());
        let page = builder.capabilities(wanted.as_object().unwrap().clone()).connect(&address).await.unwrap();
        let session = format!("{address}/session/{}", page.session_id().await.unwrap().unwrap());
        let browser = Browser { driver, _folder: folder, session, page, http: reqwest::Client::new() };
        browser.look(width, height, dark).await;
        browser
    }

    /// Sets the size of the window and the colour scheme.
    pub async fn look(&self, width: u32, height: u32, dark: bool) {
        let size = json!({"width": width, "height": height, "deviceScaleFactor": 1, "mobile": false});
        self.command("Emulation.setDeviceMetricsOverride", &size).await;
        self.command("Emulation.setScrollbarsHidden", &json!({"hidden": true})).await;
        let scheme = if dark { "dark" } else { "light" };
        let features = json!({"features": [{"name": "prefers-color-scheme", "value": scheme}]});
        self.command("Emulation.setEmulatedMedia", &features).await;
    }

    async fn command(&self, name: &str, parameters: &Value) {
        self.post("goog/cdp/execute", &json!({"cmd": name, "params": parameters})).await;
    }

    async fn post(&self, path: &str, body: &Value) -> Value {
        let reply = self.http.post(format!("{}/{path}", self.session)).json(body).send().await.unwrap();
        let mut reply: Value = reply.json().await.unwrap();
        assert!(reply["value"]["error"].is_null(), "{path} {reply}");
        reply["value"].take()
    }

    /// What the browser has logged since the last call.
    async fn log(&self, kind: &str) -> Vec<Value> {
        self.post("se/log", &json!({"type": kind})).await.as_array().unwrap().clone()
    }

    /// Asserts that since the last call the browser logged nothing but lines with one of the `known` words, and sent
    /// requests to the host of `base` alone.
    pub async fn stayed_quiet_and_at(&self, base: &str, known: &[&str]) {
        for complaint in self.log("browser").await {
            let text = complaint["message"].as_str().unwrap();
            assert!(known.iter().any(|known| text.contains(known)), "{text}");
        }
        let mut asked = 0;
        for entry in self.log("performance").await {
            let message: Value = serde_json::from_str(entry["message"].as_str().unwrap()).unwrap();
            if message["message"]["method"] == "Network.requestWillBeSent" {
                let url = message["message"]["params"]["request"]["url"].as_str().unwrap();
                assert!([base, "data:", "blob:"].iter().any(|allowed| url.starts_with(allowed)), "{url}");
                asked += 1;
            }
        }
        assert!(asked > 0, "no request was seen at all");
    }

    /// Lets the page save files in a folder.
    pub async fn save_in(&self, folder: &std::path::Path) {
        let parameters = json!({"behavior": "allow", "downloadPath": folder.to_str().unwrap()});
        self.command("Browser.setDownloadBehavior", &parameters).await;
    }

    /// An element, once it is there.
    pub async fn find(&self, css: &str) -> Element {
        let found = self.page.wait().at_most(PATIENCE).for_element(Locator::Css(css)).await;
        found.unwrap_or_else(|error| panic!("{css}: {error}"))
    }

    /// The value of an expression of JavaScript.
    pub async fn value(&self, expression: &str) -> Value {
        let found = self.page.execute(&format!("return {expression};"), vec![]).await;
        found.unwrap_or_else(|error| panic!("{expression}: {error}"))
    }

    /// Waits until an expression is true.
    pub async fn until(&self, expression: &str) {
        let deadline = Instant::now() + PATIENCE;
        while self.value(expression).await != json!(true) {
            if Instant::now() > deadline {
                let shown = self.value("document.body.innerText").await;
                panic!("not so: {expression}\n{}", shown.as_str().unwrap_or_default());
            }
            tokio::time::sleep(Duration::from_millis(50)).await;
        }
    }

    /// Writes a text in place of what a field has; again if the page has drawn the field anew meanwhile, with a state
    /// that came.
    pub async fn write(&self, css: &str, text: &str) {
        const TRIES: usize = 5;
        for _ in 0..TRIES {
            let field = self.find(css).await;
            field.clear().await.unwrap();
            field.send_keys(text).await.unwrap();
            // The field may be another element by now.
            if self.value(&format!("document.querySelector({css:?})?.value")).await == json!(text) {
                break;
            }
        }
    }

    /// Chooses a file of the repository in a field.
    pub async fn upload(&self, css: &str, file: &str) {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
        self.find(css).await.send_keys(path.to_str().unwrap()).await.unwrap();
    }

    /// Where the parts of an element across its width are, at half its height, for the mouse; the element is brought
    /// into view.
    async fn across(&self, css: &str) -> impl Fn(f64) -> PointerAction {
        let element = self.find(css).await;
        let argument = serde_json::to_value(&element).unwrap();
        self.page.execute("arguments[0].scrollIntoView({block: 'center'})", vec![argument]).await.unwrap();
        let (_, _, width, _) = element.rectangle().await.unwrap();
        // Counted from the middle of the element.
        move |part: f64| PointerAction::MoveToElement {
            element: element.clone(),
            duration: Some(Duration::from_millis(10)),
            x: (part - 0.5) * width,
            y: 0.0,
        }
    }

    /// Moves the mouse to a part of the width of an element.
    pub async fn hover(&self, css: &str, part: f64) {
        let at = self.across(css).await;
        self.page.perform_actions(MouseActions::new("mouse".to_owned()).then(at(part))).await.unwrap();
    }

    /// Presses the mouse on an element, moves it across its width in small steps, and lets go.
    pub async fn drag(&self, css: &str, from: f64, to: f64) {
        let at = self.across(css).await;
        let mut mouse = MouseActions::new("mouse".to_owned())
            .then(at(from))
            .then(PointerAction::Down { button: MOUSE_BUTTON_LEFT });
        for step in 1..=20 {
            mouse = mouse.then(at(from + (to - from) * f64::from(step) / 20.0));
        }
        self.page.perform_actions(mouse.then(PointerAction::Up { button: MOUSE_BUTTON_LEFT })).await.unwrap();
    }

    /// Ends the browser.
    pub async fn close(self) {
        self.page.clone().close().await.unwrap();
    }

    /// Chooses an entry of the list below a label.
    pub async fn choose(&self, label: &str, value: &str) {
        let id = "[...document.querySelectorAll('label')].find((one) => one.innerText === ";
        let id = self.value(&format!("{id}{label:?})?.htmlFor")).await;
        self.set(&format!("#{}", id.as_str().unwrap()), value).await;
    }

    /// Puts a value into a field at once, as pasting and choosing do.
    pub async fn set(&self, css: &str, value: &str) {
        self.find(css).await;
        let script = "const field = document.querySelector(arguments[0]); field.value = arguments[1]; \
                      for (const name of ['input', 'change']) field.dispatchEvent(new Event(name, { bubbles: true }));";
        self.page.execute(script, vec![json!(css), json!(value)]).await.unwrap();
    }

    /// The words of an element in one line.
    pub async fn text(&self, css: &str) -> String {
        self.find(css).await;
        self.value(&words(css)).await.as_str().unwrap().to_owned()
    }

    /// Waits until an element has these words.
    pub async fn says(&self, css: &str, text: &str) {
        self.until(&format!("{}?.includes({text:?})", words(css))).await;
    }

    /// Waits until there are so many elements.
    pub async fn counts(&self, css: &str, count: usize) {
        self.until(&format!("document.querySelectorAll({css:?}).length === {count}")).await;
    }

    /// Opens what is folded.
    pub async fn unfold(&self, css: &str) {
        self.value(&format!("document.querySelectorAll({css:?}).forEach((one) => one.open = true) ?? null")).await;
    }

    /// Scrolls to an element and clicks on it.
    pub async fn click(&self, css: &str) {
        self.find(css).await;
        self.value(&format!("document.querySelector({css:?}).click() ?? null")).await;
    }

    /// Presses keys on an element.
    pub async fn press(&self, css: &str, keys: &str) {
        self.find(css).await;
        self.value(&format!("document.querySelector({css:?}).focus() ?? null")).await;
        let focused = self.page.active_element().await.unwrap();
        focused.send_keys(keys).await.unwrap();
    }

    /// Saves a screenshot of the whole page in the folder that [`SCREENSHOTS`] names, if it is set.
    pub async fn picture(&self, name: &str) {
        let Some(folder) = std::env::var_os(SCREENSHOTS) else { return };
        let picture = self.page.screenshot().await.unwrap();
        std::fs::write(PathBuf::from(folder).join(format!("{name}.png")), picture).unwrap();
    }
}

/// The words of an element in one line, as an expression.
pub fn words(css: &str) -> String {
    format!("document.querySelector({css:?})?.innerText.replace(/\\s+/g, ' ')")
}

impl Drop for Browser {
    fn drop(&mut self) {
        // Chromium's headless shell outlives its driver. The connections of the test need its runtime, which may wait
        // for this very call: hence another one.
        let end = || {
            let ending =
                async { reqwest::Client::new().delete(&self.session).timeout(PATIENCE).send().await.map(drop) };
            tokio::runtime::Runtime::new().map(|runtime| runtime.block_on(ending))
        };
        let _ = std::thread::scope(|scope| scope.spawn(end).join());
        let _ = self.driver.kill();
        let _ = self.driver.wait();
    }
}

//! The views: their windows and colours, the tabs of a contact with their addresses, what the first of them says, and
//! what can be taken away.

use std::f64::consts::PI;

use serde_json::{Value, json};
use stickslip::access::{Role, new_key};
use stickslip_wire::client::Options;
use stickslip_wire::{CreateRequest, Move};
use tempfile::tempdir;

use crate::axe;
use crate::browser::{Browser, words};
use crate::common::process::Process;
use crate::common::{ball, create, until};
use crate::scene::{LIVE, Scene};
use crate::{four, pascals, three};

/// What the address of each tab has behind that of its contact.
const TABS: [&str; 6] = ["", "/loop", "/crack", "/damping", "/residual", "/accuracy"];

#[tokio::test]
async fn it_fits_small_windows_and_dark_rooms_and_needs_no_mouse() {
    let scene = Scene::start().await;
    let browser = &scene.browser;
    scene.moved(&[0.9, -0.7, 0.5, -0.3, 0.4]).await;
    let mut grounds = Vec::new();
    for (name, width, height, dark) in [
        ("narrow-light", 390, 844, false),
        ("narrow-dark", 390, 844, true),
        ("wide-dark", 1280, 900, true),
        ("wide-light", 1280, 900, false),
    ] {
        browser.look(width, height, dark).await;
        let contact = format!("contacts/{}", scene.ball.id);
        let tabs = TABS.map(|tab| format!("{contact}{tab}"));
        let mut titles: Vec<Vec<String>> = Vec::new();
        for view in ["", "new"].into_iter().chain(tabs.iter().map(String::as_str)) {
            scene.view(view).await;
            browser.find("h1").await;
            browser.until("document.documentElement.scrollWidth <= innerWidth").await;
            if view.ends_with("crack") {
                browser.find("#plot-below .shade").await;
            }
            if *view == contact {
                browser.counts(".plot .slipping", 1).await;
            }
            if view.ends_with("damping") {
                browser.find("#plot-map .line").await;
            }
            // On a phone the controls stay in reach, wherever the page is scrolled to.
            let follows = view.starts_with(&contact) && !["loop", "accuracy"].iter().any(|tab| view.ends_with(tab));
            for part in if follows && width < 400 { &[0.0, 0.4, 0.8][..] } else { &[] } {
                let scroll = format!("scrollTo(0, {part} * (document.documentElement.scrollHeight - innerHeight))");
                browser.value(&scroll).await;
                let reach = "(() => { const slider = document.querySelector('#slide-displacement'); \
                             const box = slider.getBoundingClientRect(); const middle = (box.top + box.bottom) / 2; \
                             return box.top > 0 && box.bottom < innerHeight && \
                             document.elementFromPoint((box.left + box.right) / 2, middle) === slider; })()";
                browser.until(reach).await;
            }
            // What is folded must fit, be readable, and have names too.
            browser.unfold("details").await;
            browser.until("document.documentElement.scrollWidth <= innerWidth").await;
            assert_eq!(axe::serious(browser).await, [""; 0], "{view} {name}");
            if view.starts_with(&contact) {
                let drawn = "[...document.querySelectorAll('.panel:not([hidden]) .chart')].map((chart) => \
                             [...chart.querySelectorAll('.title')].map((title) => title.textContent))\
                             .filter((titles) => titles.length)";
                titles.extend(serde_json::from_value::<Vec<Vec<String>>>(browser.value(drawn).await).unwrap());
            }
            let part = if *view == contact { "live" } else { view.rsplit('/').next().unwrap() };
            browser.picture(&format!("{name}-{part}")).await;
        }
        // Both axes of every plot are named, and have their unit but where they count.
        assert_eq!(titles.len(), 6);
        for title in titles.iter().flatten() {
            assert!(title == "Move" || title.ends_with(')'), "{title}");
        }
        assert!(titles.iter().all(|titles| titles.len() == 2), "{titles:?}");
        grounds.push(browser.value("getComputedStyle(document.body).backgroundColor").await);
    }
    assert_eq!((&grounds[0], &grounds[1]), (&grounds[3], &grounds[2]));
    assert_ne!(grounds[0], grounds[1]);

    // As many turning points are marked as there are pieces beyond the two that a virgin contact has once it moves;
    // passing one wipes out what came after it.
    scene.open(&scene.ball, "").await;
    for (part, turns) in [(-0.4, 3), (-0.8, 1)] {
        scene.moved(&[part]).await;
        assert_eq!(scene.now().await.1.memory_depth, turns + 2);
        browser.counts("#plot-loop .turn", turns).await;
    }
    // What is under the pointer is read and marked, in the plot from above too.
    browser.hover("#plot-stress svg", 0.3).await;
    browser.find("#plot-above .cursor .ring").await;
    let off = "(() => { const plot = document.querySelector('#plot-stress svg').getBoundingClientRect(); \
               const mark = document.querySelector('#plot-stress .cursor line').getBoundingClientRect(); \
               return Math.abs(mark.left - plot.left - 0.3 * plot.width); })()";
    let off = browser.value(off).await.as_f64().unwrap();
    assert!(off < 2.0, "marked {off} pixels beside the pointer");
    // By keyboard: a slider moves the contact, a plot reads its values, and a menu opens, closes and gives the focus
    // back.
    browser.press("#slide-displacement", "\u{e014}\u{e007}").await;
    until("the slider moves the contact", async || (scene.now().await.0 == 8).then_some(())).await;
    browser.press("#plot-stress svg", "\u{e011}").await;
    let centre = browser.value("document.querySelector('#plot-stress .said').textContent").await;
    let p_max = 3.0 * 10.0 / (2.0 * PI * scene.ball.contact.contact_radius.powi(2));
    assert!(centre.as_str().unwrap().contains(&format!("pressure p {} GPa", four(p_max / 1e9))), "{centre}");
    let button = "#plot-loop .menu > button";
    browser.press(button, "\u{e007}").await;
    let under = format!(
        "(() => {{ const [menu, button] = ['.menu > :popover-open', {button:?}].map((css) => \
         document.querySelector(css).getBoundingClientRect()); return Math.abs(menu.right - button.right) < 2 && \
         Math.abs(menu.top - button.bottom) < 2; }})()"
    );
    browser.find(".menu > :popover-open").await;
    browser.until(&under).await;
    browser.picture("menu").await;
    browser.press(button, "\u{e00c}").await;
    browser.counts(":popover-open", 0).await;
    browser.until(&format!("document.activeElement === document.querySelector({button:?})")).await;
    scene.end(&[]).await;
}

/// Which panel is shown.
const PANEL: &str = "[...document.querySelectorAll('.panel:not([hidden])')].map((panel) => panel.id).join()";

#[tokio::test]
async fn each_tab_has_an_address_that_survives_reload_back_and_links() {
    let scene = Scene::start().await;
    let browser = &scene.browser;
    scene.moved(&[0.9, -0.7]).await;
    scene.open(&scene.ball, "").await;
    let names = ["live", "loop", "crack", "damping", "residual", "accuracy"];
    let links = "[...document.querySelectorAll('.tabs a')].map((link) => link.textContent).join('|')";
    let titles = "Live|Measured loop|Will it crack?|Damping|Residual stress|Accuracy";
    assert_eq!(browser.value(links).await, titles);
    for (name, tab) in names.iter().zip(TABS).skip(1) {
        browser.click(&format!("#to-{name}")).await;
        browser.until(&format!("{PANEL} === 'tab-{name}' && location.hash.endsWith({tab:?})")).await;
        browser.until(&format!("document.querySelector('.tabs [aria-current]').id === 'to-{name}'")).await;
    }
    browser.until("document.title === 'Accuracy · Steel ball – stickslip'").await;
    // There the solvers are compared; no name lies on another.
    browser.click("#compute-accuracy").await;
    browser.until("document.querySelectorAll('#plot-accuracy .dot').length >= 3").await;
    let names = browser.value("document.querySelector('#plot-accuracy').textContent").await;
    assert!(names.as_str().unwrap().contains("exact") && names.as_str().unwrap().contains("springs"), "{names}");
    let lie = "(() => { const boxes = [...document.querySelectorAll('#plot-accuracy .series-name')].map((name) => \
               name.getBoundingClientRect()); return boxes.length >= 3 && boxes.every((one, index) => \
               boxes.slice(index + 1).every((two) => one.right < two.left || two.right < one.left || one.bottom - 2 < \
               two.top || two.bottom - 2 < one.top)); })()";
    assert_eq!(browser.value(lie).await, true);
    axe::assert_readable(browser, "accuracy").await;
    browser.page.refresh().await.unwrap();
    browser.until(&format!("{PANEL} === 'tab-accuracy'")).await;
    browser.page.back().await.unwrap();
    browser.until(&format!("{PANEL} === 'tab-residual' && location.hash.endsWith('/residual')")).await;
    // One menu has the requests, the link, and the files of the plots of its tab.
    browser.counts(".copying", 1).await;
    let entries = "[...document.querySelectorAll('.copying [popover] button')].map((one) => one.ariaLabel ?? \
                   one.textContent)";
    let entries: Vec<String> = serde_json::from_value(browser.value(entries).await).unwrap();
    assert_eq!(entries[..3], ["Copy as curl", "Copy as Python", "Copy link"]);
    assert!(entries[3..].iter().any(|entry| entry.ends_with("as CSV")), "{entries:?}");
    // Of all that can be reached by keyboard, what deletes is last.
    let last =
        "[...document.querySelectorAll('main a, main button, main input, main select, main textarea')].at(-1).id";
    assert_eq!(browser.value(last).await, "delete");

    // Undo keeps the tab and the place on the page, and never shows an empty one.
    browser.click("#to-damping").await;
    browser.value("document.querySelector('main').style.setProperty('min-height', '3000px') ?? scrollTo(0, 200)").await;
    browser.until("scrollY === 200").await;
    let watch = "(window.blank = false, new MutationObserver(() => { window.blank ||= !document.querySelector('h1'); })\
                 .observe(document.querySelector('main'), { childList: true, subtree: true }), null)";
    browser.value(watch).await;
    browser.click("#undo").await;
    scene.shown(Some(scene.ball.id)).await;
    browser.until(&format!("{PANEL} === 'tab-damping'")).await;
    assert_eq!(browser.value("[window.blank, scrollY]").await, json!([false, 200]));

    // What a contact cannot do is not shown.
    let mut request = create();
    let curve = json!({"type": "load_curve", "indentation": [0.0, 1e-6, 2e-6], "normal_force": [0.0, 5.0, 14.0]});
    request.profile = serde_json::from_value(curve).unwrap();
    let curve = scene.server.client.create(&request, &Options::default()).await.unwrap();
    scene.open(&curve, "/crack").await;
    let links = "[...document.querySelectorAll('.tabs a')].map((link) => link.id).join()";
    browser.until(&format!("{links} === 'to-live,to-loop,to-damping,to-accuracy' && {PANEL} === 'tab-live'")).await;
    let plots = "[...document.querySelectorAll('#tab-live .plot')].map((plot) => plot.id).join()";
    assert_eq!(browser.value(plots).await, "plot-loop,plot-work");
    scene.end(&[]).await;
}

#[tokio::test]
async fn bodies_that_conduct_have_their_conductance_and_unlike_ones_the_size_of_their_coupling() {
    let scene = Scene::start().await;
    let mut request = create();
    let copper = json!({"youngs_modulus": 1.2e11, "poisson_ratio": 0.34, "resistivity": 1.7e-8, "conductivity": 390.0});
    let steel = json!({"youngs_modulus": 2.1e11, "poisson_ratio": 0.3, "resistivity": 1e-7, "conductivity": 50.0});
    request.material = serde_json::from_value(json!({"bodies": [copper, steel]})).unwrap();
    let session = scene.server.client.create(&request, &Options::default()).await.unwrap();
    scene.open(&session, "").await;
    let browser = &scene.browser;
    // Holm (1967): the resistance of the constriction, and its heat.
    let radius = session.contact.contact_radius;
    let (electrical, thermal) = (4.0 * radius / 1.17e-7, 4.0 * radius / (1.0 / 390.0 + 1.0 / 50.0));
    browser.says(".state-text", &format!("Electrical conductance {} kS", four(electrical / 1e3))).await;
    browser.says(".state-text", &format!("Thermal conductance {} mW/K", four(thermal * 1e3))).await;
    browser.says("#trust-card", "Stiffer by coupling, at most").await;
}

#[tokio::test]
async fn the_state_its_stress_and_its_warnings_are_in_sight_and_curves_are_not_covered() {
    let scene = Scene::start().await;
    let browser = &scene.browser;
    let said = ".state-text";
    // Equal bodies with Poisson's ratio zero: no warning is due.
    let mut request = create();
    let body = json!({"youngs_modulus": 2.1e11, "poisson_ratio": 0.0});
    request.material = serde_json::from_value(json!({"bodies": [body, body]})).unwrap();
    let quiet = scene.server.client.create(&request, &Options::default()).await.unwrap();
    assert!(quiet.warnings.is_empty() && !scene.ball.warnings.is_empty(), "{:?}", quiet.warnings);
    for session in [&quiet, &scene.ball] {
        scene.open(session, "").await;
        browser.says(said, "Largest shear stress 0 Pa = 0 % of μ p").await;
        browser.until("document.querySelector('#trust-card dd') !== null").await;
        browser.counts("#warnings li", session.warnings.len()).await;
    }
    // After gross slip it is the whole of it; one reversal from there by the displacement of gross slip brings it to
    // the middle, with sqrt(1/2).
    let full = 0.3 * scene.ball.contact.max_pressure.unwrap();
    for (part, share) in [(1.5, 1.0), (0.5, 0.5_f64.sqrt())] {
        scene.moved(&[part]).await;
        let share = format!("{} = {} % of μ p", pascals(full * share, 4), three(100.0 * share));
        browser.says(said, &format!("Largest shear stress {share}")).await;
    }
    // A tooltip names its values, and covers no curve.
    scene.moved(&[-0.7, 0.5]).await;
    browser.until("document.querySelector('#plot-loop .line.past')?.getAttribute('d').split('L').length > 20").await;
    let covered = "(() => { const box = document.querySelector('#plot-loop .cursor .label \
                   rect').getBoundingClientRect(); const way = document.querySelector('#plot-loop .line.past'); const \
                   at = way.getScreenCTM(); return Array.from({ length: 500 }, (_, index) => \
                   way.getPointAtLength(way.getTotalLength() * index / 499).matrixTransform(at)).filter((p) => p.x > \
                   box.left && p.x < box.right && p.y > box.top && p.y < box.bottom).length; })()";
    for part in [0.2, 0.35, 0.5, 0.65, 0.8] {
        browser.hover("#plot-loop svg", part).await;
        browser.find("#plot-loop .cursor .label").await;
        assert_eq!(browser.value(covered).await, 0, "at {part} of the width");
    }
    // The same move in the other plot has its values with their names.
    let lines = browser.value("document.querySelector('#plot-work .said').textContent").await;
    let lines = lines.as_str().unwrap();
    assert!(lines.contains("friction work ") && lines.contains("stored "), "{lines}");
    // A contact that is lifted off says so.
    for (normal_force, indentation) in [(Some(0.0), None), (None, Some(-1e-8))] {
        scene.apply(Move { normal_force, indentation, ..Move::default() }).await;
        browser.until(&format!("{0}.startsWith('Lifted off') && !{0}.includes('Stick')", words(said))).await;
        scene.apply(Move { normal_force: Some(10.0), ..Move::default() }).await;
        browser.until(&format!("!{}.includes('Lifted off')", words(said))).await;
    }

    // After a slip of the finger the axes fit the recent moves, and all are a key away.
    scene.moved(&[1e4]).await;
    scene.moved(&(0..12).map(|index| 0.5 * f64::from(index % 3 - 1)).collect::<Vec<_>>()).await;
    let unit = "document.querySelector('#plot-loop .title').textContent";
    browser.until(&format!("{unit} === 'Displacement U (nm)'")).await;
    // The widest displacement that a tick of the axis has, nm.
    let ticks = "[...document.querySelectorAll('#plot-loop .grid text')].map((text) => text.textContent.replace('−', \
                 '-')).map(Number).filter(Number.isFinite)";
    let widest = browser.value(&format!("Math.max(...{ticks}.map(Math.abs))")).await.as_f64().unwrap();
    assert!(widest < 2e9 * scene.ball.contact.gross_slip_displacement, "{widest} nm");
    browser.press("#plot-loop svg", "0").await;
    browser.until(&format!("{unit} === 'Displacement U (mm)'")).await;
    scene.end(&[]).await;
}

#[tokio::test]
async fn what_is_on_screen_can_be_taken_away() {
    let scene = Scene::start().await;
    let browser = &scene.browser;
    scene.moved(&[0.9, -0.7]).await;
    let folder = tempdir().unwrap();
    browser.save_in(folder.path()).await;
    scene.open(&scene.ball, "").await;
    browser.counts("#plot-loop .line", 2).await;
    // Zoom to a part of a plot, and back to all of it.
    let ticks = "[...document.querySelectorAll('#plot-loop .grid text')].map((text) => text.textContent).join()";
    let all = browser.value(ticks).await;
    browser.drag("#plot-loop svg", 0.6, 0.7).await;
    browser.until(&format!("{ticks} !== {all}")).await;
    browser.press("#plot-loop svg", "0").await;
    browser.until(&format!("{ticks} === {all}")).await;
    let saved = async |plot: &str, entry: usize, ending: &str| -> Vec<u8> {
        browser.click(&format!("#plot-{plot} .menu [popover] button:nth-of-type({entry})")).await;
        let path = folder.path().join(format!("{plot}.{ending}"));
        let read = async || std::fs::read(&path).ok().filter(|bytes| !bytes.is_empty());
        until("the file is saved", read).await
    };
    assert!(saved("loop", 4, "png").await.starts_with(b"\x89PNG\r\n\x1a\n"));
    let drawing = String::from_utf8(saved("loop", 5, "svg").await).unwrap();
    assert!(drawing.starts_with("<svg") && drawing.contains("Displacement U") && !drawing.contains("class="));
    for name in ["Hysteresis loop", "whole path", "since the last reversal"] {
        assert!(drawing.contains(name), "the title and the legend are part of it: {name}");
    }
    let view = drawing.split("viewBox=\"").nth(1).unwrap().split('"').next().unwrap();
    assert!(view.split(' ').all(|number| number.parse::<i32>().is_ok()), "whole pixels: {view}");
    let table = String::from_utf8(saved("loop", 6, "csv").await).unwrap();
    assert_eq!(table.lines().count(), 3, "{table}");
    // The colours go up to the largest stress that is there.
    let drawing = String::from_utf8(saved("above", 5, "svg").await).unwrap();
    let residual = reqwest::get(format!("{}/contacts/{}/residual", scene.server.base, scene.ball.id)).await;
    let largest = residual.unwrap().json::<Value>().await.unwrap()["max"].as_f64().unwrap();
    let most = pascals(largest, 3);
    let (number, unit) = most.split_once(' ').unwrap();
    assert!(drawing.contains(&format!(">τ: −{number} to +{number} {unit}<")), "{most}");
    assert!(drawing.contains("<stop") && drawing.contains("rgb(") && !drawing.contains("oklab("));
    // The commands are those of this contact, and they work.
    browser.click(".copying [popover] button").await;
    let commands = browser.value("document.querySelector('#code textarea').value").await;
    let last = commands.as_str().unwrap().split("\n\n").last().unwrap();
    let url = last.split('\'').find(|word| word.starts_with("http")).unwrap();
    let body: Value = serde_json::from_str(last.rsplit('\'').nth(1).unwrap()).unwrap();
    assert_eq!(url, format!("{}/contacts/{}/move", scene.server.base, scene.ball.id));
    let reply = reqwest::Client::new().post(url).json(&body).send().await.unwrap();
    assert_eq!(reply.status(), 200);
    assert_eq!(reply.json::<Value>().await.unwrap()["sequence"], 3);
    browser.picture("code").await;
    scene.end(&[]).await;
}

#[tokio::test]
async fn it_asks_for_a_key_where_one_is_needed_and_finds_by_label() {
    let new = new_key("page", &[Role::Write], "", None).unwrap();
    let server = Process::with("memory:", &["--keys", &new.entry]);
    let http = reqwest::Client::new();
    for label in ["Steel ball", "Rubber foot"] {
        let mut body = ball();
        body["label"] = json!(label);
        let call = http.post(format!("{}/contacts", server.base)).bearer_auth(&new.key).json(&body);
        assert_eq!(call.send().await.unwrap().status(), 201);
    }
    let browser = Browser::start(400, 850, true).await;
    browser.page.goto(&server.base).await.unwrap();
    browser.until("document.querySelector('#key').open").await;
    browser.write("#key input", &new.key).await;
    browser.click("#key .primary").await;
    let rows = "[...document.querySelectorAll('.list strong')].map((name) => name.innerText).join()";
    browser.until(&format!("{rows} === 'Rubber foot,Steel ball'")).await;
    let shapes = "[...document.querySelectorAll('.list .shape')].map((shape) => shape.innerText)";
    browser.until(&format!("{shapes}.every((shape) => shape === 'Sphere (Hertz’s parabola), 10 N')")).await;
    for (text, found) in [("EL BA", "Steel ball"), ("nothing", ""), ("steel", "Steel ball")] {
        browser.write("#search", text).await;
        browser.until(&format!("{rows} === {found:?}")).await;
    }
    browser.click(".list a").await;
    browser.until(LIVE).await;
    // The key stays in this tab, and out of what is copied.
    browser.click(".copying [popover] button").await;
    let commands = browser.value("document.querySelector('#code textarea').value").await;
    let commands = commands.as_str().unwrap();
    assert!(commands.contains("Bearer $STICKSLIP_KEY") && !commands.contains(&new.key), "{commands}");
    assert_eq!(browser.value("JSON.stringify(localStorage) + document.cookie").await, "{}");
    browser.stayed_quiet_and_at(&server.base, &["status of 401"]).await;
    browser.close().await;
}

#[tokio::test]
async fn pictures_of_the_documentation() {
    let mut scene = Scene::over(Process::with("memory:", &[]), 1440, 1130, false).await;
    // The ball of the other examples, on steel.
    let file = std::fs::read_to_string("examples/data/ball_contact.json").unwrap();
    let request = CreateRequest { label: Some("Steel ball".to_owned()), ..serde_json::from_str(&file).unwrap() };
    scene.ball = scene.server.client.create(&request, &Options::default()).await.unwrap();
    let browser = &scene.browser;
    scene.moved(&[0.9, -0.7, 0.5, -0.3, 0.4]).await;
    scene.open(&scene.ball, "").await;
    browser.counts("#plot-above .slipping", 1).await;
    browser.until("document.querySelector('#plot-loop .line.past')?.getAttribute('d').split('L').length > 20").await;
    // The warnings of the contact come last.
    browser.until("!document.querySelector('#warned').hidden").await;
    browser.picture("contact").await;
    scene.open(&scene.ball, "/crack").await;
    browser.set("#crack-card fieldset .field:nth-child(2) input", "300").await;
    browser.click("#compute-crack").await;
    browser.find("#plot-crack .shade").await;
    browser.picture("crack").await;
    browser.look(390, 844, false).await;
    scene.open(&scene.ball, "").await;
    browser.counts("#plot-loop .line", 2).await;
    browser.value("document.querySelector('#plot-loop').scrollIntoView() ?? null").await;
    browser.picture("narrow").await;
    scene.end(&[]).await;
}

#[tokio::test]
async fn figures_say_what_they_mean_and_the_help_lists_them() {
    let scene = Scene::start().await;
    let browser = &scene.browser;
    scene.moved(&[0.5]).await;
    scene.open(&scene.ball, "").await;
    let said = "[...document.querySelectorAll('.state-text [title]')].map((row) => row.title).join()";
    browser.until(&format!("{said}.includes('The work that friction has dissipated so far')")).await;
    browser.click("nav a[href='#/help']").await;
    browser.says("h1", "Help").await;
    browser.says("main", "The work that friction has dissipated so far").await;
    axe::assert_readable(browser, "help").await;
    scene.end(&[]).await;
}

/// A fretting map takes milliseconds: nobody has to ask for it.
#[tokio::test]
async fn what_takes_little_time_is_there_before_a_button_is_pressed() {
    let scene = Scene::start().await;
    let browser = &scene.browser;
    scene.moved(&[0.5]).await;
    scene.open(&scene.ball, "/damping").await;
    browser.until("document.querySelectorAll('#plot-map .line').length > 3").await;
    browser.click("#to-residual").await;
    browser.says("#search-figures", "Remains").await;
    scene.end(&[]).await;
}

//! The page at `/`, in a real browser.

mod axe;
mod browser;
#[path = "../common/mod.rs"]
mod common;
mod comparing;
mod files;
mod journeys;
mod moving;
mod plots;
mod questions;

use std::f64::consts::PI;
use std::path::Path;
use std::time::Duration;

use browser::{Browser, PATIENCE};
use common::{Binary, create};
use reqwest::header;
use serde_json::{Value, json};
use stickslip::access::{Role, new_key};
use stickslip_wire::client::Options;
use stickslip_wire::{
    CreateRequest, Move, MoveRequest, NewSession, Observation, ObservationsRequest, PathRequest, Steps,
};
use tempfile::tempdir;
use tokio::time::{sleep, timeout};

/// The steel ball of the examples, with a name.
async fn ball(server: &Binary) -> NewSession {
    let request = CreateRequest { label: Some("Steel ball".to_owned()), ..create() };
    server.client.create(&request, &Options::default()).await.unwrap()
}

async fn moved(server: &Binary, session: &NewSession, parts: &[f64]) {
    for part in parts {
        let step = Move::displacement(part * session.contact.gross_slip_displacement);
        server.client.apply(session.id, &MoveRequest::from(step), &Options::default()).await.unwrap();
    }
}

/// A number of one to a thousand with four digits, without trailing zeros.
fn four(value: f64) -> String {
    let places = 3 - value.log10().floor() as usize;
    format!("{value:.places$}").parse::<f64>().unwrap().to_string()
}

/// A number of one to a thousand with three digits, without trailing zeros.
fn three(value: f64) -> String {
    let places = 2 - value.log10().floor() as usize;
    format!("{value:.places$}").parse::<f64>().unwrap().to_string()
}

/// Hertz's contact radius in µm, as the page shows it.
fn hertz(force: f64, radius: f64, modulus: f64) -> String {
    format!("{} µm", four(1e6 * (3.0 * force * radius / (4.0 * modulus)).cbrt()))
}

/// What the address of each tab has behind that of its contact.
const TABS: [&str; 6] = ["", "/loop", "/crack", "/damping", "/residual", "/accuracy"];
const E_STAR: f64 = 2.1e11 / (1.0 - 0.3 * 0.3);
/// The drawn path of the loop, `[x, y]` in pixels; an empty one while the page draws it.
const WAY: &str = "(document.querySelector('#plot-loop .line.past')?.getAttribute('d') ?? \
    '').slice(1).split('L').map((p) => p.split(',').map(Number))";

#[tokio::test]
async fn a_contact_is_made_moved_reloaded_and_followed() {
    let server = Binary::start(&[]);
    let browser = Browser::start(1280, 900, false).await;
    browser.page.goto(&server.address).await.unwrap();
    browser.until("document.body.innerText.includes('No contact yet')").await;
    browser.click("#new").await;

    // Figures are shown as one types, and a fault is shown at its field.
    let figures = "document.querySelector('.derived').innerText";
    browser.until(&format!("{figures}.includes({:?})", hertz(10.0, 0.01, E_STAR))).await;
    let radius = "form .card:first-child input";
    browser.write(radius, "20").await;
    browser.until(&format!("{figures}.includes({:?})", hertz(10.0, 0.02, E_STAR))).await;
    browser.write(radius, "-20").await;
    let fault =
        "document.querySelector('form .card:first-child input').closest('.field').querySelector('.fault').innerText";
    browser.until(&format!("{fault}.includes('out of range')")).await;
    browser.picture("new").await;
    browser.write(radius, "10").await;
    browser.until(&format!("{fault} === ''")).await;
    browser.write("input[maxlength]", "Steel ball").await;
    browser.click("#create").await;
    browser.until("document.querySelector('.badge.on') !== null").await;
    // The browser logs that a reply was an error.
    browser.stayed_quiet_and_at(&server.address, &["status of 422"]).await;

    // Pulled to one side and back, the force returns along another path.
    browser.drag("#slide-displacement", 0.5, 0.8).await;
    browser.until(&format!("{WAY}.length > 5")).await;
    browser.drag("#slide-displacement", 0.8, 0.35).await;
    let turned = format!(
        "(() => {{ const way = {WAY}; const x = way.map((p) => p[0]); const top = x.indexOf(Math.max(...x)); \
         const middle = (x[0] + x[top]) / 2; const out = way.slice(0, top).find((p) => p[0] >= middle); \
         const back = way.slice(top).find((p) => p[0] <= middle); \
         return out !== undefined && back !== undefined && x.at(-1) < x[0] && back[1] > out[1] + 10; }})()"
    );
    browser.until(&turned).await;
    let id = server.client.contacts(None, None).await.unwrap().items[0].id;
    // The last moves of the slider may still be under way.
    let agree = async {
        loop {
            let force = server.client.contact(id).await.unwrap().state.force;
            let shown = browser.value("Number(document.querySelector('#box-force').value)").await;
            if (shown.as_f64().unwrap() - force).abs() < 1e-4 {
                break;
            }
        }
    };
    timeout(PATIENCE, agree).await.expect("the page shows what the server has");
    browser.picture("turned").await;

    // The history is still there after a reload.
    let moves = server.client.contact(id).await.unwrap().sequence;
    browser.page.refresh().await.unwrap();
    browser
        .until(
            "document.querySelector('.badge.on') !== null && document.querySelector('#plot-loop .line.past') !== null",
        )
        .await;
    browser.until(&turned).await;
    browser.until(&format!("{WAY}.length > {moves}")).await;
    assert_eq!(browser.value("document.querySelector('h1').innerText").await, "Steel ball");

    // Moves by another client are shown at once.
    let step = Move { normal_force: Some(15.0), displacement: Some(5e-8), ..Move::default() };
    server.client.apply(id, &MoveRequest::from(step), &Options::default()).await.unwrap();
    browser.until("document.querySelector('#box-displacement').value === '50'").await;
    browser
        .until(&format!("document.querySelector('.side').innerText.includes({:?})", hertz(15.0, 0.01, E_STAR)))
        .await;
    server.client.delete(id, &Options::default()).await.unwrap();
    browser.until("document.querySelector('.badge').innerText === 'deleted'").await;
    // What was asked of the contact while it was deleted is logged.
    browser.stayed_quiet_and_at(&server.address, &["status of 404"]).await;
    browser.close().await;
}

#[tokio::test]
async fn it_fits_small_windows_and_dark_rooms_and_needs_no_mouse() {
    let server = Binary::start(&[]);
    let session = ball(&server).await;
    moved(&server, &session, &[0.9, -0.7, 0.5, -0.3, 0.4]).await;
    let browser = Browser::start(400, 850, false).await;
    let mut grounds = Vec::new();
    for (name, width, height, dark) in [
        ("narrow-light", 400, 850, false),
        ("narrow-dark", 400, 850, true),
        ("wide-dark", 1280, 900, true),
        ("wide-light", 1280, 900, false),
    ] {
        browser.look(width, height, dark).await;
        let contact = format!("#/contacts/{}", session.id);
        let tabs = TABS.map(|tab| format!("{contact}{tab}"));
        let mut titles: Vec<Vec<String>> = Vec::new();
        for view in ["#/", "#/new"].into_iter().chain(tabs.iter().map(String::as_str)) {
            browser.page.goto(&format!("{}/{view}", server.address)).await.unwrap();
            browser.until("document.querySelector('h1') !== null").await;
            browser.until("document.documentElement.scrollWidth <= innerWidth").await;
            if view.ends_with("crack") {
                browser.until("document.querySelector('#plot-below .shade') !== null").await;
            }
            if *view == contact {
                browser.until("document.querySelectorAll('.plot .slipping').length === 1").await;
            }
            // What is folded must fit, be readable, and have names too.
            browser.value("document.querySelectorAll('details').forEach((one) => one.open = true) ?? null").await;
            browser.until("document.documentElement.scrollWidth <= innerWidth").await;
            assert_eq!(axe::serious(&browser).await, [""; 0], "{view} {name}");
            if view.starts_with(&contact) {
                let drawn = browser
                    .value(
                        "[...document.querySelectorAll('.panel:not([hidden]) .chart')].map((chart) => \
                         [...chart.querySelectorAll('.title')].map((title) => title.textContent))\
                         .filter((titles) => titles.length)",
                    )
                    .await;
                titles.extend(serde_json::from_value::<Vec<Vec<String>>>(drawn).unwrap());
            }
            let part = if *view == contact { "live" } else { view.rsplit('/').next().unwrap() };
            browser.picture(&format!("{name}-{part}")).await;
        }
        // Both axes of every plot are named, and have their unit but where they count.
        assert_eq!(titles.len(), 5);
        for title in titles.iter().flatten() {
            assert!(title == "Move" || title.ends_with(')'), "{title}");
        }
        assert!(titles.iter().all(|titles| titles.len() == 2), "{titles:?}");
        grounds.push(browser.value("getComputedStyle(document.body).backgroundColor").await);
    }
    browser.page.goto(&format!("{}/#/contacts/{}", server.address, session.id)).await.unwrap();
    browser.until("document.querySelectorAll('.plot .slipping').length === 1").await;
    assert_eq!((&grounds[0], &grounds[1]), (&grounds[3], &grounds[2]));
    assert_ne!(grounds[0], grounds[1]);

    // As many turning points are marked as there are pieces beyond the two that a virgin contact has once it moves;
    // passing one wipes out what came after it.
    for (part, turns) in [(-0.4, 3), (-0.8, 1)] {
        moved(&server, &session, &[part]).await;
        let depth = server.client.contact(session.id).await.unwrap().state.memory_depth;
        assert_eq!(depth, turns + 2);
        browser.until(&format!("document.querySelectorAll('#plot-loop .turn').length === {turns}")).await;
    }

    // What is under the pointer is read and marked, in the plot from above too.
    browser.hover("#plot-stress svg", 0.3).await;
    let off = "(() => { const plot = document.querySelector('#plot-stress svg').getBoundingClientRect(); \
               const mark = document.querySelector('#plot-stress .cursor line').getBoundingClientRect(); \
               return Math.abs(mark.left - plot.left - 0.3 * plot.width); })()";
    browser.until("document.querySelector('#plot-above .cursor .ring') !== null").await;
    let off = browser.value(off).await.as_f64().unwrap();
    assert!(off < 2.0, "marked {off} pixels beside the pointer");

    // By keyboard: a slider moves the contact, and a plot reads its values.
    browser.press("#slide-displacement", "\u{e014}\u{e007}").await;
    browser.until("document.querySelector('.badge.on') !== null").await;
    let arrived = async {
        while server.client.contact(session.id).await.unwrap().sequence < 8 {
            sleep(Duration::from_millis(20)).await;
        }
    };
    timeout(PATIENCE, arrived).await.expect("the slider moves the contact");
    browser.press("#plot-stress svg", "\u{e011}").await;
    let centre = browser.value("document.querySelector('#plot-stress .said').textContent").await;
    let p_max = 3.0 * 10.0 / (2.0 * PI * session.contact.contact_radius.powi(2));
    assert!(centre.as_str().unwrap().contains(&format!("pressure p {} GPa", four(p_max / 1e9))), "{centre}");
    browser.stayed_quiet_and_at(&server.address, &[]).await;
    browser.close().await;
}

#[tokio::test]
async fn a_protocol_run_reduces_the_stress_and_shows_how_much() {
    let server = Binary::start(&[]);
    let session = ball(&server).await;
    moved(&server, &session, &[1.0, 0.0]).await;
    let browser = Browser::start(1280, 900, false).await;
    browser.page.goto(&format!("{}/#/contacts/{}/residual", server.address, session.id)).await.unwrap();
    browser.write("#reversals", "4").await;
    browser.click("#run").await;
    let status = "document.querySelector('#run-status').innerText";
    browser.until(&format!("{status}.startsWith('Move')")).await;
    // One reversal leaves sqrt(1/2) of mu p_max, and more of them (2 - sqrt(3/2)) / sqrt(N_R).
    let left = 100.0 * (2.0 - 1.5_f64.sqrt()) / 2.0;
    let before = 100.0 * 0.5_f64.sqrt();
    browser.until(&format!("{status}.includes('Now')")).await;
    let said = browser.value(status).await;
    let said = said.as_str().unwrap();
    assert!(said.contains(&format!("({before:.1} %")) && said.contains(&format!("({left:.1} %")), "{said}");
    let now = server.client.contact(session.id).await.unwrap();
    assert_eq!((now.sequence, now.state.displacement), (7, 0.0));

    browser.click("#compute-residual").await;
    browser.until("document.querySelectorAll('#plot-residual .dot').length >= 4 * 15 + 7").await;
    browser.press("#plot-residual svg", "\u{e011}").await;
    let one = browser.value("document.querySelector('#plot-residual .said').textContent").await;
    assert!(one.as_str().unwrap().contains("linear: largest 0.7071"), "{one}");
    // With two reversals the least is 3/(4 sqrt 2), and with one no protocol is better than another.
    assert!(one.as_str().unwrap().contains("least possible (found by search): largest 0.7071"), "{one}");
    browser.press("#plot-residual svg", "\u{e014}").await;
    let two = browser.value("document.querySelector('#plot-residual .said').textContent").await;
    assert!(two.as_str().unwrap().contains("largest 0.5303"), "{two}");
    axe::assert_readable(&browser, "run").await;
    browser.stayed_quiet_and_at(&server.address, &[]).await;
    browser.close().await;
}

#[tokio::test]
async fn a_path_of_cycles_runs_from_the_page_and_says_its_work_or_its_fault() {
    let server = Binary::start(&[]);
    let session = ball(&server).await;
    let browser = Browser::start(1280, 900, false).await;
    browser.page.goto(&format!("{}/#/contacts/{}", server.address, session.id)).await.unwrap();
    browser.click("#compute-path").await;
    let status = "document.querySelector('#path-status').innerText";
    browser.until(&format!("{status}.startsWith('Done')")).await;
    // Five cycles with the two moves of each, and the first to a turn.
    let now = server.client.contact(session.id).await.unwrap();
    assert_eq!(now.sequence, 11);
    let turn = now.state.displacement / session.contact.gross_slip_displacement;
    assert!((turn - 0.5).abs() < 1e-3, "{turn}");

    browser.write("#path-card textarea", r#"{"cycles": {"displacement": 1e-7, "count": 0}}"#).await;
    browser.click("#compute-path").await;
    let fault = "document.querySelector('#path-card .fault').innerText";
    browser.until(&format!("{fault}.startsWith('cycles/count')")).await;
    browser.write("#path-card textarea", "up and down").await;
    browser.click("#compute-path").await;
    browser.until(&format!("{fault}.includes('not JSON')")).await;
    assert_eq!(server.client.contact(session.id).await.unwrap().sequence, 11);
    // Chromium logs each refusal.
    browser.stayed_quiet_and_at(&server.address, &["status of 422"]).await;
    browser.close().await;
}

#[tokio::test]
async fn the_best_run_keeps_its_promise_and_solvers_are_compared() {
    let server = Binary::start(&[]);
    let session = ball(&server).await;
    // A history that no closed-form protocol starts from.
    moved(&server, &session, &[0.9, -0.3, 0.5]).await;
    let relax = format!("{}/contacts/{}/relax", server.address, session.id);
    let dry = reqwest::Client::new().post(relax).json(&json!({"reversals": 3, "dry_run": true})).send().await.unwrap();
    let promised = dry.json::<Value>().await.unwrap()["residual"]["max"].as_f64().unwrap();
    let browser = Browser::start(1280, 900, false).await;
    browser.page.goto(&format!("{}/#/contacts/{}/residual", server.address, session.id)).await.unwrap();
    browser.until("document.querySelector('#protocol option[value=relax]') !== null").await;
    browser.value("document.querySelector('#protocol').value = 'relax'").await;
    browser.write("#reversals", "3").await;
    browser.click("#run").await;
    let status = "document.querySelector('#run-status').innerText";
    browser.until(&format!("{status}.includes('Now')")).await;
    let said = browser.value(status).await;
    let now = said.as_str().unwrap().split("Now: up to").nth(1).unwrap();
    let share = 100.0 * promised / (0.3 * session.contact.max_pressure.unwrap());
    assert!(now.contains(&format!("({share:.1} % of")), "{said} instead of {share}");

    browser.click("#to-accuracy").await;
    browser.click("#compute-accuracy").await;
    browser.until("document.querySelectorAll('#plot-accuracy .dot').length >= 3").await;
    let names = browser.value("document.querySelector('#plot-accuracy').textContent").await;
    assert!(names.as_str().unwrap().contains("exact") && names.as_str().unwrap().contains("springs"), "{names}");
    // No name lies on another.
    let lie = "(() => { const boxes = [...document.querySelectorAll('#plot-accuracy .series-name')].map((name) => \
               name.getBoundingClientRect()); return boxes.length >= 3 && boxes.every((one, index) => \
               boxes.slice(index + 1).every((two) => one.right < two.left || two.right < one.left || one.bottom - 2 < \
               two.top || two.bottom - 2 < one.top)); })()";
    assert_eq!(browser.value(lie).await, true);
    axe::assert_readable(&browser, "accuracy").await;
    browser.stayed_quiet_and_at(&server.address, &[]).await;
    browser.close().await;
}

/// Friction work of a steady cycle of the ball, J, whose amplitude is this part of the displacement of gross slip
/// (Mindlin & Deresiewicz 1953).
fn work_of_cycle(session: &NewSession, part: f64) -> f64 {
    let left = 1.0 - part;
    let area = part - 0.4 * (1.0 - left.powf(2.5)) - 0.5 * (1.0 - left.powf(1.5)) * part;
    8.0 * area * session.contact.gross_slip_force * session.contact.gross_slip_displacement
}

#[tokio::test]
async fn the_steady_cycle_follows_the_slider() {
    let server = Binary::start(&[]);
    let session = ball(&server).await;
    let browser = Browser::start(1280, 900, false).await;
    browser.page.goto(&format!("{}/#/contacts/{}/damping", server.address, session.id)).await.unwrap();
    browser.find("#steady-card").await;
    let card = "document.querySelector('#steady-card').innerText";
    browser.until(&format!("{card}.includes('Pull the displacement')")).await;
    for part in [0.5, -0.9] {
        moved(&server, &session, &[part]).await;
        let work = format!("{} nJ", four(1e9 * work_of_cycle(&session, part.abs())));
        browser.until(&format!("{card}.includes({work:?}) && {card}.includes('inside, the surfaces stick')")).await;
    }
    // F over U, the force that of a first loading.
    let (force, displacement) = (session.contact.gross_slip_force, session.contact.gross_slip_displacement);
    let stiffness = four(1e-6 * (1.0 - 0.1_f64.powf(1.5)) * force / (0.9 * displacement));
    browser.until(&format!("{card}.includes({:?})", format!("{stiffness} MN/m"))).await;
    browser.value("document.querySelector('#steady-card').scrollIntoView()").await;
    axe::assert_readable(&browser, "steady").await;
    // Dragged to the end and back to the middle, it ends with what belongs there.
    browser.drag("#slide-displacement", 0.2, 0.99).await;
    browser.until(&format!("{card}.includes('slides in each stroke')")).await;
    browser.click("button[id=compute-path]").await;
    browser.until(&format!("{card}.includes('inside, the surfaces stick')")).await;
    moved(&server, &session, &[0.0]).await;
    browser.until(&format!("{card}.includes('Pull') && !{card}.includes('J')")).await;
    let apart = Move { indentation: Some(-1e-9), displacement: Some(1e-8), ..Move::default() };
    server.client.apply(session.id, &MoveRequest::from(apart), &Options::default()).await.unwrap();
    browser.until(&format!("{card}.includes('Without a load') && !{card}.includes('J')")).await;
    browser.click("#compute-map").await;
    browser.until("document.querySelector('#plot-map .line.bound') !== null").await;
    browser.stayed_quiet_and_at(&server.address, &[]).await;
    browser.close().await;
}

#[tokio::test]
async fn measured_points_are_drawn_over_the_loop_with_the_friction_that_they_show() {
    let server = Binary::start(&[]);
    let session = ball(&server).await;
    // Measured on a contact with another friction.
    let bench = server.client.create(&CreateRequest { friction: 0.4, ..create() }, &Options::default()).await.unwrap();
    let reach = 3.0 * session.contact.gross_slip_displacement;
    let turn = |step: usize| reach * (std::f64::consts::TAU * step as f64 / 20.0).cos();
    let slide = async |steps: std::ops::Range<usize>| {
        let path = stickslip_wire::Path::Displacement(steps.map(turn).collect());
        let path = PathRequest { path, stress: None, steps: Steps::All, tolerance: None };
        let states = server.client.path(bench.id, &path, &Options::default()).await.unwrap().steps;
        let measured =
            states.iter().map(|state| Observation { displacement: state.displacement, force: state.force, at: None });
        let request = ObservationsRequest { observations: measured.collect() };
        server.client.observe(session.id, &request, &Options::default()).await.unwrap();
    };
    slide(0..15).await;
    let browser = Browser::start(1280, 900, false).await;
    browser.page.goto(&format!("{}/#/contacts/{}", server.address, session.id)).await.unwrap();
    let dots = "document.querySelectorAll('#plot-loop .dot.measured').length";
    let said = "document.querySelector('.state-text').innerText";
    browser.until(&format!("{dots} === 15 && !{said}.includes('Measured')")).await;
    slide(15..21).await;
    browser.until(&format!("{dots} === 21 && {said}.includes('Measured friction μ')")).await;
    browser.until(&format!("{said}.includes('0.4 (95 %: 0.4 to 0.4, moves 1 to 21)')")).await;
    browser.picture("measured").await;
    // A contact that nobody measures says nothing of it.
    browser.page.goto(&format!("{}/#/contacts/{}", server.address, bench.id)).await.unwrap();
    browser.until(&format!("{dots} === 0 && document.querySelector('#plot-loop .line.past') !== null")).await;
    browser.stayed_quiet_and_at(&server.address, &[]).await;
    browser.close().await;
}

#[tokio::test]
async fn the_mark_of_a_fretting_map_is_where_its_lines_say() {
    let server = Binary::start(&[]);
    let session = ball(&server).await;
    let browser = Browser::start(1280, 900, false).await;
    browser.page.goto(&format!("{}/#/contacts/{}/damping", server.address, session.id)).await.unwrap();
    browser.click("#compute-map").await;
    let bound = "document.querySelector('#plot-map .line.bound')";
    browser.until(&format!("{bound} !== null && document.querySelector('#plot-map .mark') === null")).await;
    // The amplitude that does 100 nJ a cycle, by bisection.
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        *(if work_of_cycle(&session, middle) < 1e-7 { &mut low } else { &mut high }) = middle;
    }
    let contour = "[...document.querySelectorAll('#plot-map text.small')].find((text) => text.textContent === '100 \
        nJ').previousSibling";
    for (part, line) in [(1.0, bound), (low, contour)] {
        moved(&server, &session, &[part]).await;
        // The height of the line at the mark, which must be within the map.
        let off = format!(
            "(() => {{ const mark = document.querySelector('#plot-map .mark'); if (!mark) return false; \
             const [x, y] = ['cx', 'cy'].map((name) => Number(mark.getAttribute(name))); \
             const way = {line}.getAttribute('d').slice(1).split('L').map((p) => p.split(',').map(Number)); \
             const next = way.findIndex((p) => p[0] >= x); if (next < 1) return false; \
             const [from, to] = [way[next - 1], way[next]]; \
             const there = from[1] + ((to[1] - from[1]) * (x - from[0])) / (to[0] - from[0]); \
             return Math.abs(there - y) < 1; }})()"
        );
        browser.until(&off).await;
    }
    browser.value("document.querySelector('#plot-map').scrollIntoView()").await;
    axe::assert_readable(&browser, "map").await;
    browser.stayed_quiet_and_at(&server.address, &[]).await;
    browser.close().await;
}

/// The largest pressure of the ball, Pa, and the parts of it that Hertz's stress on the axis has at a depth in contact
/// radii: von Mises and the mean, under this Poisson's ratio.
fn below(session: &NewSession, poisson: f64, depth: f64) -> (f64, f64) {
    let most = 3.0 * 10.0 / (2.0 * PI * session.contact.contact_radius.powi(2));
    let axial = -1.0 / (1.0 + depth * depth);
    let radial = -(1.0 + poisson) * (1.0 - depth * (1.0 / depth).atan()) - 0.5 * axial;
    (most * (axial - radial).abs(), most * (axial + 2.0 * radial) / 3.0)
}

/// Three digits in MPa or GPa, as the page shows them.
fn pascals(value: f64) -> String {
    let (value, unit) = if value >= 1e9 { (value / 1e9, "GPa") } else { (value / 1e6, "MPa") };
    format!("{} {unit}", three(value))
}

#[tokio::test]
async fn the_stress_below_the_surface_follows_the_moves() {
    let server = Binary::start(&[]);
    let session = ball(&server).await;
    let browser = Browser::start(1280, 900, false).await;
    browser.page.goto(&format!("{}/#/contacts/{}/crack", server.address, session.id)).await.unwrap();
    let text = "document.querySelector('#below-text')?.innerText";
    let says = |words: &str| format!("{text}?.includes({words:?})");
    // Of the rows of the section, the one at 0.5 a is nearest to Hertz's depth of 0.48 a.
    let (mises, _) = below(&session, 0.3, 0.5);
    let depth = format!("{:.1} µm below the surface at x = 0.", 0.5e6 * session.contact.contact_radius);
    browser.until(&says(&format!("Largest von Mises stress {}, {depth}", pascals(mises)))).await;
    let bodies = "[...document.querySelector('#below-card select').options].map((option) => option.value).join()";
    assert_eq!(browser.value(bodies).await, "first", "a rigid body has no stress");
    assert_eq!(browser.value("document.querySelectorAll('#below-card input').length").await, 0);
    // The edges are at a quarter and three quarters of four contact radii, and the darkest shade is where the ring is.
    let drawn = "(() => { const frame = document.querySelector('#plot-below rect.field').getBBox(); \
                 const edges = [...document.querySelectorAll('#plot-below .contact-edge')].map((line) => \
                 (line.getBBox().x - frame.x) / frame.width); const dark = [...document.querySelectorAll('#plot-below \
                 .shade')].at(-1).getBBox(); const ring = document.querySelector('#plot-below .mark'); \
                 const [x, y] = ['cx', 'cy'].map((name) => Number(ring.getAttribute(name))); \
                 return Math.abs(edges[0] - 0.25) < 1e-3 && Math.abs(edges[1] - 0.75) < 1e-3 && Math.abs((y - frame.y) \
                 / frame.height - 1 / 3) < 1e-3 && x > dark.x && x < dark.x + dark.width && y > dark.y && y < dark.y + \
                 dark.height; })()";
    browser.until(drawn).await;
    browser.choose("Stress", "max_shear").await;
    browser.until(&says(&format!("Largest shear stress on any plane {}, {depth}", pascals(0.5 * mises)))).await;
    browser.choose("Stress", "hydrostatic").await;
    let (_, mean) = below(&session, 0.3, 1e-9);
    browser.until(&says(&format!("Largest mean compression {}, on the surface at x = 0.", pascals(-mean)))).await;
    browser.choose("Stress", "von_mises").await;
    browser.until(&says(&pascals(mises))).await;
    browser.value("document.querySelector('#below-card').scrollIntoView() ?? null").await;
    browser.picture("below").await;

    // It follows moves by another client and the slider, and ends with what belongs to the last of them.
    moved(&server, &session, &[0.9, -0.7]).await;
    browser.until(&says(&largest(&server, &session).await)).await;
    browser.drag("#slide-displacement", 0.3, 0.95).await;
    moved(&server, &session, &[1.5]).await;
    let sliding = largest(&server, &session).await;
    browser.until(&says(&sliding)).await;
    assert_ne!(sliding, pascals(mises), "friction adds to it");
    browser.picture("below-sliding").await;
    // By keyboard, from the upper left corner to the right.
    browser.press("#plot-below svg", "\u{e011}\u{e014}").await;
    let corner = browser.value("document.querySelector('#plot-below .said').textContent").await;
    let corner = corner.as_str().unwrap();
    assert!(
        corner.contains("Depth z 0 m, von Mises stress") && corner.starts_with("x, along the motion −"),
        "{corner}"
    );
    let apart = Move { indentation: Some(-1e-9), displacement: Some(1e-8), ..Move::default() };
    server.client.apply(session.id, &MoveRequest::from(apart), &Options::default()).await.unwrap();
    browser.until(&format!("{} && document.querySelector('#plot-below').hidden", says("do not press"))).await;
    browser.stayed_quiet_and_at(&server.address, &[]).await;
    browser.close().await;
}

/// The largest von Mises stress of the section that the page shows, as the service has it now.
async fn largest(server: &Binary, session: &NewSession) -> String {
    let a = server.client.contact(session.id).await.unwrap().state.contact_radius;
    let plane = json!({"normal": "y", "offset": 0.0, "x": [-2.0 * a, 2.0 * a, 61], "z": [0.0, 1.5 * a, 31]});
    let request = json!({"body": "first", "plane": plane, "fields": ["von_mises"]});
    let request = serde_json::from_value(request).unwrap();
    let reply = server.client.subsurface(session.id, &request).await.unwrap();
    pascals(reply.stress.von_mises.unwrap().into_iter().flatten().fold(0.0, f64::max))
}

#[tokio::test]
async fn below_the_surface_reduced_moduli_need_a_poissons_ratio_and_an_edge_is_infinite() {
    let server = Binary::start(&[]);
    let mut request = create();
    let material = json!({"effective": {"e_star": 2.31e11, "g_star": 1.9e11}});
    request.material = serde_json::from_value(material).unwrap();
    let session = server.client.create(&request, &Options::default()).await.unwrap();
    request.profile = serde_json::from_value(json!({"type": "flat_punch", "radius": 1e-4})).unwrap();
    let punch = server.client.create(&request, &Options::default()).await.unwrap();
    let browser = Browser::start(400, 850, true).await;
    browser.page.goto(&format!("{}/#/contacts/{}/crack", server.address, session.id)).await.unwrap();
    let text = "document.querySelector('#below-text')?.innerText";
    for (typed, poisson) in [("0.3", 0.3), ("0", 0.0), ("0,5", 0.5)] {
        browser.write("#below-card input", typed).await;
        browser.choose("Stress", "hydrostatic").await;
        let (_, mean) = below(&session, poisson, 1e-9);
        browser.until(&format!("{text}?.includes({:?})", pascals(-mean))).await;
    }
    browser.choose("Stress", "von_mises").await;
    browser.choose("Body", "second").await;
    browser.until(&format!("{text}?.includes({:?})", pascals(below(&session, 0.5, 0.55).0))).await;
    browser.value("document.querySelector('#below-card').scrollIntoView() ?? null").await;
    browser.until("document.documentElement.scrollWidth <= innerWidth").await;
    browser.picture("below-narrow").await;
    browser.write("#below-card input", "0.7").await;
    let fault = "[...document.querySelectorAll('#below-card .fault')].map((fault) => fault.innerText).join('')";
    browser.until(&format!("{fault}.includes('0.5') && document.querySelector('#plot-below').hidden")).await;
    browser.write("#below-card input", "0.5").await;
    browser.until(&format!("{fault} === '' && !document.querySelector('#plot-below').hidden")).await;

    browser.page.goto(&format!("{}/#/contacts/{}/crack", server.address, punch.id)).await.unwrap();
    browser.until(&format!("{text}?.startsWith('Infinite on the surface at x = −100 µm, where')")).await;
    browser.stayed_quiet_and_at(&server.address, &["status of 422"]).await;
    browser.close().await;
}

/// The file that the page saves, once it is complete.
async fn saved(path: &Path) -> Vec<u8> {
    for _ in 0..600 {
        if let Ok(bytes) = std::fs::read(path)
            && !bytes.is_empty()
        {
            return bytes;
        }
        sleep(Duration::from_millis(50)).await;
    }
    panic!("{} has not been saved", path.display());
}

#[tokio::test]
async fn what_is_on_screen_can_be_taken_away() {
    let server = Binary::start(&[]);
    let session = ball(&server).await;
    moved(&server, &session, &[0.9, -0.7]).await;
    let folder = tempdir().unwrap();
    let browser = Browser::start(1280, 900, false).await;
    browser.save_in(folder.path()).await;
    browser.page.goto(&format!("{}/#/contacts/{}", server.address, session.id)).await.unwrap();
    browser.until("document.querySelectorAll('#plot-loop .line').length === 2").await;
    // Zoom to a part of a plot, and back to all of it.
    let ticks = "[...document.querySelectorAll('#plot-loop .grid text')].map((text) => text.textContent).join()";
    let all = browser.value(ticks).await;
    browser.drag("#plot-loop svg", 0.6, 0.7).await;
    browser.until(&format!("{ticks} !== {all}")).await;
    browser.press("#plot-loop svg", "0").await;
    browser.until(&format!("{ticks} === {all}")).await;
    for (entry, name) in [(4, "loop.png"), (5, "loop.svg"), (6, "loop.csv")] {
        browser.click(&format!("#plot-loop .menu [popover] button:nth-of-type({entry})")).await;
        let file = saved(&folder.path().join(name)).await;
        let text = String::from_utf8_lossy(&file);
        match name {
            "loop.png" => assert!(file.starts_with(b"\x89PNG\r\n\x1a\n")),
            "loop.svg" => {
                assert!(text.starts_with("<svg") && text.contains("Displacement U") && !text.contains("class="));
                for name in ["Hysteresis loop", "whole path", "since the last reversal"] {
                    assert!(text.contains(name), "the title and the legend are part of it: {name}");
                }
                let view = text.split("viewBox=\"").nth(1).unwrap().split('"').next().unwrap();
                assert!(view.split(' ').all(|number| number.parse::<i32>().is_ok()), "whole pixels: {view}");
            }
            _ => assert_eq!(text.lines().count(), 3, "{text}"),
        }
    }
    browser.click("#plot-above .menu [popover] button:nth-of-type(5)").await;
    let drawing = String::from_utf8(saved(&folder.path().join("above.svg")).await).unwrap();
    // The colours go up to the largest stress that is there.
    let state = reqwest::get(format!("{}/contacts/{}/stress?points=2&residual=true", server.address, session.id)).await;
    let largest = state.unwrap().json::<Value>().await.unwrap()["residual"]["max"].as_f64().unwrap();
    let most = pascals(largest);
    let (number, unit) = most.split_once(' ').unwrap();
    assert!(drawing.contains(&format!(">τ: −{number} to +{number} {unit}<")), "{most}");
    assert!(drawing.contains("<stop") && drawing.contains("rgb(") && !drawing.contains("oklab("));
    // The commands are those of this contact, and they work.
    browser.click(".copying [popover] button").await;
    let commands = browser.value("document.querySelector('#code textarea').value").await;
    let commands = commands.as_str().unwrap();
    let last = commands.split("\n\n").last().unwrap();
    let url = last.split('\'').find(|word| word.starts_with("http")).unwrap();
    let body: Value = serde_json::from_str(last.rsplit('\'').nth(1).unwrap()).unwrap();
    assert_eq!(url, format!("{}/contacts/{}/move", server.address, session.id));
    let reply = reqwest::Client::new().post(url).json(&body).send().await.unwrap();
    assert_eq!(reply.status(), 200);
    assert_eq!(reply.json::<Value>().await.unwrap()["sequence"], 3);
    browser.picture("code").await;
    browser.stayed_quiet_and_at(&server.address, &[]).await;
    browser.close().await;
}

#[tokio::test]
async fn every_shape_body_and_preload_can_be_chosen() {
    let server = Binary::start(&[]);
    let browser = Browser::start(1280, 900, false).await;
    browser.page.goto(&format!("{}/#/new", server.address)).await.unwrap();
    browser.until("document.querySelector('form select') !== null").await;
    let types = browser.value("[...document.querySelector('form select').options].map((option) => option.value)").await;
    let types: Vec<String> = serde_json::from_value(types).unwrap();
    let document = server.client.openapi().await.unwrap();
    assert_eq!(types.len(), document["components"]["schemas"]["Profile"]["oneOf"].as_array().unwrap().len());
    let shapes = types.iter().map(|kind| ("Shape of the indenter", kind.as_str(), "/profile/type", json!(kind)));
    let bodies = [
        ("Elasticity", "two", "/material/bodies/1/poisson_ratio", json!(0.3)),
        ("Elasticity", "effective", "/material/effective/e_star", json!(2.31e11)),
        ("Preload by", "indentation", "/preload/indentation", json!(1e-6)),
        ("Preload by", "contact_radius", "/preload/contact_radius", json!(1e-4)),
    ];
    for (label, value, pointer, expected) in shapes.chain(bodies) {
        browser.value("location.assign('#/new') ?? null").await;
        browser.until("document.querySelector('#create') !== null").await;
        browser.choose(label, value).await;
        if value == "tabulated" {
            browser.write("form textarea", "# µm\n0;0\n100;0,5\n200;2,0\n300;4,5").await;
        }
        browser.click("#create").await;
        browser.until("location.hash.startsWith('#/contacts/') && document.querySelector('.badge.on') !== null").await;
        let hash = browser.value("location.hash").await;
        let id = hash.as_str().unwrap().rsplit('/').next().unwrap().parse().unwrap();
        let made = serde_json::to_value(server.client.definition(id).await.unwrap()).unwrap();
        assert_eq!(made.pointer(pointer), Some(&expected), "{value}");
        if value == "ellipsoid" {
            assert_eq!(made["profile"], json!({"type": "ellipsoid", "radii": [0.01, 0.005], "direction": "x"}));
        }
        if value == "tabulated" {
            assert_eq!(made["profile"]["r"], json!([0.0, 1e-4, 2e-4, 3e-4]));
            assert_eq!(made["profile"]["z"], json!([0.0, 5e-7, 2e-6, 4.5e-6]));
        }
    }
    // A table that is not whole yet is refused, and the browser itself says so.
    browser.stayed_quiet_and_at(&server.address, &["status of 422"]).await;
    browser.close().await;
}

/// Puts a text into a field at once, as pasting does.
async fn pasted(browser: &Browser, field: &str, text: &str) {
    let paste = format!(
        "(() => {{ const field = document.querySelector({field:?}); field.value = {}; field.dispatchEvent(new \
         Event('input', {{ bubbles: true }})); }})() ?? null",
        json!(text)
    );
    browser.value(&paste).await;
}

#[tokio::test]
async fn a_pasted_scan_becomes_the_profile_of_the_contact() {
    let server = Binary::start(&[]);
    let browser = Browser::start(1280, 900, false).await;
    browser.page.goto(&format!("{}/#/new", server.address)).await.unwrap();
    browser.until("document.querySelector('form select') !== null").await;
    browser.choose("Shape of the indenter", "tabulated").await;
    // A ball of 10 mm, 7 µm off the middle, upside down, with a header; 1 nm up and down of noise.
    let row = |index: i32| {
        let x = f64::from(index) * 2.0 - 120.0;
        format!("{x};{:.5}", -(x - 7.0).powi(2) / 2e4 + 0.001 * f64::from((index * 37) % 21 - 10) / 10.0)
    };
    let scan = format!("Lateral;Height\n{}", (0..=120).map(row).collect::<Vec<_>>().join("\n"));
    pasted(&browser, "form textarea", &scan).await;
    browser.click("#fit-scan").await;
    browser.until("document.querySelector('#scan-said').textContent.startsWith('Radius 10')").await;
    browser.click("#create").await;
    browser.until("location.hash.startsWith('#/contacts/') && document.querySelector('.badge.on') !== null").await;
    let hash = browser.value("location.hash").await;
    let id = hash.as_str().unwrap().rsplit('/').next().unwrap().parse().unwrap();
    let made = serde_json::to_value(server.client.contact(id).await.unwrap()).unwrap();
    // Hertz: a^3 = 3 F R/(4 E*).
    let radius = (0.75 * 10.0 * 0.01 / (2.1e11 / 0.91_f64)).cbrt();
    let found = made["contact"]["contact_radius"].as_f64().unwrap();
    assert!((found / radius - 1.0).abs() < 0.01, "{found} of {radius}");
    // The form asks what follows from the scan as it is, which is no table, and the browser itself says so.
    browser.stayed_quiet_and_at(&server.address, &["status of 422"]).await;
    browser.close().await;
}

#[tokio::test]
async fn a_pasted_loop_becomes_friction_and_a_contact() {
    let server = Binary::start(&[]);
    let session = ball(&server).await;
    let browser = Browser::start(1280, 900, false).await;
    browser.page.goto(&format!("{}/#/contacts/{}/loop", server.address, session.id)).await.unwrap();
    browser.find("textarea[name=loop]").await;
    // What a rig has recorded of such a ball with a friction of 0.42: time, displacement in µm and force, with decimal
    // commas.
    let table = std::fs::read_to_string("examples/data/ball_loop.csv").unwrap();
    // Three columns without their names: nobody knows which they are, and the fault is shown.
    let rows = table.lines().filter(|line| line.starts_with(|first: char| first.is_ascii_digit()));
    pasted(&browser, "textarea[name=loop]", &rows.collect::<Vec<_>>().join("\n")).await;
    browser.until("document.querySelector('#loop-card').innerText.includes('no column “displacement”')").await;
    browser.click("#compute-loop").await;
    let card = "document.querySelector('#compute-loop').closest('.card')";
    browser.until(&format!("[...{card}.querySelectorAll('.fault')].some((one) => one.innerText.length > 20)")).await;
    for (name, column) in [("displacement", "2"), ("force", "3")] {
        let place = format!(
            "(() => {{ const field = document.querySelector('[aria-label=\"Column of {name}\"]'); field.value = \
             '{column}'; field.dispatchEvent(new Event('change', {{ bubbles: true }})); }})() ?? null"
        );
        browser.value(&place).await;
    }
    // Nor does anything say their units: they are asked for, and not taken for metres.
    browser.until("document.querySelector('#loop-card').innerText.includes('The force is column 3, in N')").await;
    browser.click("#compute-loop").await;
    let question = "Record 1: nothing says the unit of the displacement, nor of the force: choose it.";
    browser.until(&format!("document.querySelector('#loop-card').innerText.includes({question:?})")).await;
    for (name, power) in [("displacement", -6), ("force", 0)] {
        let unit = format!(
            "(() => {{ const unit = document.querySelector('[aria-label=\"Unit of {name}\"]'); unit.value = '{power}'; \
             unit.dispatchEvent(new Event('change', {{ bubbles: true }})); }})() ?? null"
        );
        browser.value(&unit).await;
    }
    browser.until("document.querySelector('#loop-card').innerText.includes('The force is column 3, in N.')").await;
    browser.click("[name=machine_compliance]").await;
    browser.click("#compute-loop").await;
    browser.until("document.querySelector('#loop-estimates').innerText.includes('friction μ')").await;
    browser.until("document.querySelectorAll('#plot-fit path.line').length === 2").await;
    assert_eq!(browser.value("document.querySelector('#loop-warnings').children.length").await, 0);
    let said = "document.querySelector('#loop-said')";
    let determined = "Determined: friction μ, G* · (R/E*)1/3, compliance of the machine";
    browser.until(&format!("{said}.innerText.includes('{determined}')")).await;
    assert_eq!(browser.value(&format!("{said}.querySelector('sup').innerText")).await, "1/3");
    axe::assert_readable(&browser, "loop-fit").await;
    browser.click("#create-fitted").await;
    browser.until(&format!("!location.hash.includes('{}')", session.id)).await;
    let hash = browser.value("location.hash").await;
    let id = hash.as_str().unwrap().rsplit('/').next().unwrap().parse().unwrap();
    let made = server.client.definition(id).await.unwrap();
    assert!((made.friction / 0.42 - 1.0).abs() < 0.02, "{made:?}");
    browser.stayed_quiet_and_at(&server.address, &["status of 422"]).await;
    browser.close().await;
}

#[tokio::test]
async fn it_asks_for_a_key_where_one_is_needed_and_finds_by_label() {
    let new = new_key("page", &[Role::Write], "").unwrap();
    let server = Binary::start(&["--keys", &new.entry]);
    let http = reqwest::Client::new();
    for label in ["Steel ball", "Rubber foot"] {
        let mut body = common::ball();
        body["label"] = json!(label);
        let call = http.post(format!("{}/contacts", server.address)).bearer_auth(&new.key).json(&body);
        assert_eq!(call.send().await.unwrap().status(), 201);
    }
    let browser = Browser::start(400, 850, true).await;
    browser.page.goto(&server.address).await.unwrap();
    browser.until("document.querySelector('#key').open").await;
    browser.write("#key input", &new.key).await;
    browser.click("#key .primary").await;
    let rows = "[...document.querySelectorAll('.list strong')].map((name) => name.innerText).join()";
    browser.until(&format!("{rows} === 'Rubber foot,Steel ball'")).await;
    browser
        .until(
            "[...document.querySelectorAll('.list .shape')].every((shape) => shape.innerText === 'Sphere \
        (Hertz’s parabola), 10 N')",
        )
        .await;
    browser.write("#search", "EL BA").await;
    browser.until(&format!("{rows} === 'Steel ball'")).await;
    browser.write("#search", "nothing").await;
    browser.until(&format!("{rows} === ''")).await;
    browser.write("#search", "steel").await;
    browser.until(&format!("{rows} === 'Steel ball'")).await;
    browser.click(".list a").await;
    browser.until("document.querySelector('.badge.on') !== null").await;
    // The key stays in this tab, and out of what is copied.
    browser.click(".copying [popover] button").await;
    let commands = browser.value("document.querySelector('#code textarea').value").await;
    let commands = commands.as_str().unwrap();
    assert!(commands.contains("Bearer $STICKSLIP_KEY") && !commands.contains(&new.key), "{commands}");
    assert_eq!(browser.value("JSON.stringify(localStorage) + document.cookie").await, "{}");
    browser.stayed_quiet_and_at(&server.address, &["status of 401"]).await;
    browser.close().await;
}

#[tokio::test]
async fn its_files_are_those_of_the_source_and_are_sent_once() {
    let server = Binary::start(&[]);
    let http = reqwest::Client::new();
    let url = format!("{}/page/main.js", server.address);
    let source = std::fs::read("src/page/main.js").unwrap();
    let mut tags = Vec::new();
    for (accepted, coding) in [("identity", None), ("br, gzip;q=0.5", Some("gzip")), ("gzip;q=0", None)] {
        let reply = http.get(&url).header(header::ACCEPT_ENCODING, accepted).send().await.unwrap();
        assert_eq!(reply.status(), 200);
        assert_eq!(reply.headers().get(header::CONTENT_ENCODING).map(|coding| coding.to_str().unwrap()), coding);
        let tag = reply.headers()[header::ETAG].clone();
        let body = reply.bytes().await.unwrap();
        assert_eq!(body == source, coding.is_none(), "{accepted}");
        let again = http.get(&url).header(header::ACCEPT_ENCODING, accepted).header(header::IF_NONE_MATCH, &tag);
        let again = again.send().await.unwrap();
        assert_eq!((again.status().as_u16(), again.headers()[header::ETAG] == tag), (304, true));
        assert!(again.bytes().await.unwrap().is_empty());
        tags.push(tag);
    }
    assert_eq!(tags[0], tags[2]);
    assert_ne!(tags[0], tags[1], "two forms of a file are two things to a cache");
    let unknown = http.get(format!("{}/page/..%2Fmain.rs", server.address)).send().await.unwrap();
    assert_eq!(common::problem(unknown).await.code, "not_found");
}

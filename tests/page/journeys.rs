//! Six journeys through the page, each from a file to a number, as somebody would go who has the one and wants the
//! other.

use serde_json::{Value, json};
use stickslip_wire::client::Options;
use stickslip_wire::{CreateRequest, NewSession, Observation, ObservationsRequest};

use crate::axe;
use crate::browser::Browser;
use crate::common::Binary;
use crate::{four, three};

/// A server and a browser that shows its list.
async fn begin() -> (Binary, Browser) {
    let server = Binary::start(&[]);
    let browser = Browser::start(1440, 900, false).await;
    browser.page.goto(&server.address).await.unwrap();
    browser.find("#new").await;
    (server, browser)
}

/// The contact that a file of the examples defines.
async fn contact_of_file(server: &Binary) -> NewSession {
    let text = std::fs::read_to_string("examples/data/ball_contact.json").unwrap();
    let request: CreateRequest = serde_json::from_str(&text).unwrap();
    server.client.create(&request, &Options::default()).await.unwrap()
}

/// Opens a contact from the list, and one of its tabs by its name.
async fn open(browser: &Browser, tab: &str) {
    browser.page.refresh().await.unwrap();
    browser.click(".list a").await;
    browser.until("document.querySelector('.badge.on') !== null").await;
    browser.click(&format!("#to-{tab}")).await;
    browser.until(&format!("!document.querySelector('#tab-{tab}').hidden")).await;
}

async fn end(server: &Binary, browser: Browser, known: &[&str]) {
    browser.stayed_quiet_and_at(&server.address, known).await;
    browser.close().await;
}

#[tokio::test]
async fn scan_a_file_of_an_instrument_becomes_the_contact_radius() {
    let (server, browser) = begin().await;
    browser.click("#new").await;
    browser.until("document.querySelector('form select') !== null").await;
    browser.choose("Shape of the indenter", "tabulated").await;
    browser.upload("form input[type=file]", "examples/data/ball_scan.txt").await;
    browser.until("document.querySelector('form').innerText.includes('x is “Lateral')").await;
    browser.click("#fit-scan").await;
    browser.until("document.querySelector('#scan-said').textContent.includes('left out')").await;
    axe::assert_readable(&browser, "journey-scan").await;
    browser.click("#create").await;
    browser.until("document.querySelector('.badge.on') !== null").await;
    let said = "document.querySelector('.state-text').innerText";
    browser.until(&format!("{said}.includes('Contact radius')")).await;
    // By quadrature of the worn ball that the file was made with it is 69.07 µm; the standard error is 0.26 µm.
    let id = server.client.contacts(None, None).await.unwrap().items[0].id;
    let radius = server.client.contact(id).await.unwrap().contact.contact_radius;
    assert!((radius / 6.907e-5 - 1.0).abs() < 0.01, "{radius}");
    browser.until(&format!("{said}.includes({:?})", format!("{} µm", four(radius * 1e6)))).await;
    // A scan is no table of a profile yet, and the form says so meanwhile.
    end(&server, browser, &["status of 422"]).await;
}

#[tokio::test]
async fn loop_a_file_of_a_bench_becomes_the_coefficient_of_friction() {
    let (server, browser) = begin().await;
    contact_of_file(&server).await;
    open(&browser, "loop").await;
    browser.upload("#loop-card input[type=file]", "examples/data/ball_loop.csv").await;
    // Columns and units come from the header, the time too.
    browser.until("document.querySelector('#loop-card').innerText.includes('The force is “Force (N)”, in N.')").await;
    browser.click("[name=machine_compliance]").await;
    browser.click("[name=drift]").await;
    browser.click("#compute-loop").await;
    let found = "document.querySelector('#loop-estimates').innerText.replaceAll('\\n', ' ')";
    browser.until(&format!("{found}.includes('friction μ 0.42')")).await;
    // The file was made with a friction of 0.42; all that was asked for has an interval.
    let said = browser.value(found).await;
    let said = said.as_str().unwrap();
    let interval = said.split("(95 %: ").nth(1).unwrap().split(')').next().unwrap();
    let (low, high) = interval.split_once(" to ").unwrap();
    let [low, high]: [f64; 2] = [low, high].map(|end| end.parse().unwrap());
    assert!(low < 0.42 && 0.42 < high && said.contains("drift of the displacement"), "{said}");
    axe::assert_readable(&browser, "journey-loop").await;
    end(&server, browser, &[]).await;
}

#[tokio::test]
async fn crack_a_file_of_a_contact_becomes_the_margin_of_a_criterion() {
    let (server, browser) = begin().await;
    let session = contact_of_file(&server).await;
    open(&browser, "crack").await;
    browser.click("#crack-card [name=crossland]").await;
    browser.click("#crack-card [name=findley]").await;
    let limit = "[...document.querySelectorAll('#crack-card fieldset')].find((one) => \
                 one.innerText.includes('Findley')).querySelectorAll('input')[2]";
    browser.value(&format!("({limit}.value = '400') && null")).await;
    browser.click("#compute-crack").await;
    browser.until("document.querySelector('#verdict-findley .good') !== null").await;
    let amplitude: f64 = format!("{:.2e}", 0.5 * session.contact.gross_slip_displacement).parse().unwrap();
    let mut contact = crate::common::ball();
    contact["preload"] = json!({"indentation": session.contact.indentation});
    let body = json!({"contact": contact, "body": "first", "criteria": {"findley": {"k": 0.3, "limit": 4e8}},
        "path": {"cycles": {"displacement": amplitude, "count": 1}}});
    let reply = reqwest::Client::new().post(format!("{}/fretting", server.address)).json(&body).send().await.unwrap();
    let margin = reply.json::<Value>().await.unwrap()["findley"]["margin"].as_f64().unwrap();
    let said = browser.value("document.querySelector('#verdict-findley .good').innerText").await;
    assert!(margin > 1.0 && margin < 10.0, "{margin}");
    let text = format!("Margin {}: the criterion does not predict crack growth.", three(margin));
    assert_eq!(said, text);
    axe::assert_readable(&browser, "journey-crack").await;
    end(&server, browser, &[]).await;
}

#[tokio::test]
async fn damping_a_file_of_a_contact_becomes_its_loss_factor() {
    let (server, browser) = begin().await;
    let session = contact_of_file(&server).await;
    open(&browser, "damping").await;
    let slip = session.contact.gross_slip_displacement;
    browser.write("#box-displacement", &format!("{:.3}", slip * 1e9)).await;
    browser.press("#box-displacement", "\u{e007}").await;
    // A ball at the onset of gross slip: 1/pi.
    let said = "document.querySelector('#steady-figures').innerText.replaceAll('\\n', ' ')";
    browser.until(&format!("/Loss factor 0\\.318/.test({said})")).await;
    // In the resonance the phase is a right angle, to a step of the frequencies.
    browser.click("#compute-response").await;
    let phase = "Number(document.querySelector('#response-figures').innerText.match(/Phase \
        there\\s+([\\d.]+)°/)?.[1])";
    browser.until(&format!("Math.abs({phase} - 90) < 5")).await;
    axe::assert_readable(&browser, "journey-damping").await;
    end(&server, browser, &[]).await;
}

#[tokio::test]
async fn residual_a_file_of_a_contact_becomes_what_twenty_reversals_leave() {
    let (server, browser) = begin().await;
    contact_of_file(&server).await;
    open(&browser, "residual").await;
    browser.click("#run").await;
    let status = "document.querySelector('#run-status').innerText";
    browser.until(&format!("{status}.includes('Now')")).await;
    // (2 − √(3/2))/√20 of μ p_max.
    let left = 100.0 * (2.0 - 1.5_f64.sqrt()) / 20.0_f64.sqrt();
    let said = browser.value(status).await;
    assert!(said.as_str().unwrap().contains("Now: up to"), "{said}");
    assert!(said.as_str().unwrap().contains(&format!("({left:.1} % of")), "{said} instead of {left}");
    axe::assert_readable(&browser, "journey-residual").await;
    end(&server, browser, &[]).await;
}

#[tokio::test]
async fn dashboard_a_file_of_a_bench_becomes_the_friction_that_is_shown_live() {
    let (server, browser) = begin().await;
    let session = contact_of_file(&server).await;
    open(&browser, "live").await;
    // The rows of the file as a bench would send them, without what the rig gives way and the zero of the force.
    let text = std::fs::read_to_string("examples/data/ball_loop.csv").unwrap();
    let number = |cell: &str| cell.replace(',', ".").parse::<f64>();
    let rows = text.lines().filter_map(|line| {
        let cells: Vec<f64> = line.split(';').map(number).collect::<Result<_, _>>().ok()?;
        let force = cells[2] - 0.15;
        Some(Observation { displacement: cells[1] * 1e-6 - 5e-8 * force, force, at: None })
    });
    let request = ObservationsRequest { observations: rows.collect() };
    let reply = server.client.observe(session.id, &request, &Options::default()).await.unwrap();
    let friction = reply.friction.expect("a cycle of the file closes").value;
    assert!((friction / 0.42 - 1.0).abs() < 0.02, "{friction}");
    let said = "document.querySelector('.state-text').innerText";
    browser.until(&format!("{said}.includes('Measured friction μ') && {said}.includes({:?})", short(friction))).await;
    browser.until("document.querySelectorAll('#plot-loop .dot.measured').length > 500").await;
    axe::assert_readable(&browser, "journey-dashboard").await;
    end(&server, browser, &[]).await;
}

/// Four digits of a number below one, without trailing zeros.
fn short(value: f64) -> String {
    format!("{value:.4}").trim_end_matches('0').to_owned()
}

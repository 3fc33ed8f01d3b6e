//! The tabs of a contact: their addresses, what each of them answers, and what a view never does.

use std::f64::consts::{PI, TAU};

use serde_json::{Value, json};
use stickslip_wire::client::Options;
use stickslip_wire::{Move, MoveRequest, NewSession};

use crate::axe;
use crate::browser::Browser;
use crate::common::{Binary, create, until};
use crate::{TABS, ball, four, moved, three};

/// Opens a tab of a contact, and waits until the page follows the contact.
async fn opened(browser: &Browser, server: &Binary, session: &NewSession, tab: &str) {
    browser.page.goto(&format!("{}/#/contacts/{}{tab}", server.address, session.id)).await.unwrap();
    browser.until("document.querySelector('.badge.on') !== null").await;
}

/// Which panel is shown, and where the address leads.
const PANEL: &str = "[...document.querySelectorAll('.panel:not([hidden])')].map((panel) => panel.id).join()";

#[tokio::test]
async fn each_tab_has_an_address_that_survives_reload_back_and_links() {
    let server = Binary::start(&[]);
    let session = ball(&server).await;
    moved(&server, &session, &[0.9, -0.7]).await;
    let browser = Browser::start(1280, 900, false).await;
    opened(&browser, &server, &session, "").await;
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
    browser.page.refresh().await.unwrap();
    browser.until(&format!("{PANEL} === 'tab-accuracy'")).await;
    browser.page.back().await.unwrap();
    browser.until(&format!("{PANEL} === 'tab-residual' && location.hash.endsWith('/residual')")).await;
    // One menu has what the nine pairs of buttons had, and the files of the plots of its tab.
    let menus = "document.querySelectorAll('.copying').length";
    assert_eq!(browser.value(menus).await, 1);
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
    browser
        .value(
            "(window.blank = false, new MutationObserver(() => { window.blank ||= !document.querySelector('h1'); })\
             .observe(document.querySelector('main'), { childList: true, subtree: true }), null)",
        )
        .await;
    browser.click("#undo").await;
    browser
        .until(&format!(
            "!location.hash.includes('{}') && {PANEL} === 'tab-damping' && document.querySelector('.badge.on') !== \
                null",
            session.id
        ))
        .await;
    assert_eq!(browser.value("[window.blank, scrollY]").await, json!([false, 200]));
    browser.stayed_quiet_and_at(&server.address, &[]).await;
    browser.close().await;
}

#[tokio::test]
async fn what_a_contact_cannot_do_is_not_shown() {
    let server = Binary::start(&[]);
    let mut request = create();
    let curve = json!({"type": "load_curve", "indentation": [0.0, 1e-6, 2e-6], "normal_force": [0.0, 5.0, 14.0]});
    request.profile = serde_json::from_value(curve).unwrap();
    let session = server.client.create(&request, &Options::default()).await.unwrap();
    let browser = Browser::start(1280, 900, false).await;
    opened(&browser, &server, &session, "/crack").await;
    let links = "[...document.querySelectorAll('.tabs a')].map((link) => link.id).join()";
    assert_eq!(browser.value(links).await, "to-live,to-loop,to-damping,to-accuracy");
    browser.until(&format!("{PANEL} === 'tab-live'")).await;
    let plots = "[...document.querySelectorAll('#tab-live .plot')].map((plot) => plot.id).join()";
    assert_eq!(browser.value(plots).await, "plot-loop,plot-work");
    browser.stayed_quiet_and_at(&server.address, &[]).await;
    browser.close().await;
}

#[tokio::test]
async fn the_worst_place_is_found_without_a_grid_judged_and_marked() {
    let server = Binary::start(&[]);
    let session = ball(&server).await;
    let browser = Browser::start(1280, 900, false).await;
    opened(&browser, &server, &session, "/crack").await;
    // Faults of two fields at once, in words.
    let limit = "[...document.querySelectorAll('#crack-card fieldset')].find((one) => \
                 one.innerText.includes('Crossland')).querySelectorAll('input')";
    for (index, text) in [(1, "much"), (2, "300 MPa")] {
        browser.value(&format!("({limit}[{index}].value = {text:?}) && null")).await;
    }
    browser.click("#compute-crack").await;
    let faults = "[...document.querySelectorAll('#crack-card .fault')].map((one) => one.innerText).filter(Boolean)";
    browser.until(&format!("{faults}.length === 2")).await;
    let said = browser.value(faults).await;
    assert_eq!(
        said,
        json!([
            "This must be a number, without its unit and without separators of thousands.",
            "This must be a number, without its unit and without separators of thousands."
        ])
    );
    for (index, text) in [(1, "0.3"), (2, "200")] {
        browser.value(&format!("({limit}[{index}].value = {text:?}) && null")).await;
    }
    // A bulk stress, and a cycle of half of gross slip.
    browser.value("(document.querySelector('#crack-card details').open = true) && null").await;
    let bulk = "[...document.querySelectorAll('#crack-card details input')]";
    browser.value(&format!("({bulk}[0].value = '50', {bulk}[1].value = '40', null)")).await;
    browser.click("#compute-crack").await;
    browser.until("document.querySelector('#plot-crack .shade') !== null").await;

    let amplitude: f64 = 0.5 * session.contact.gross_slip_displacement;
    let amplitude: f64 = format!("{amplitude:.2e}").parse().unwrap();
    let mut contact = crate::common::ball();
    contact["preload"] = json!({"indentation": session.contact.indentation});
    let body = json!({
        "contact": contact, "body": "first", "path": {"cycles": {"displacement": amplitude, "count": 1}},
        "criteria": {"crossland": {"alpha": 0.3, "limit": 2e8}}, "bulk": {"mean": 5e7, "amplitude": 4e7}
    });
    let reply = reqwest::Client::new().post(format!("{}/fretting", server.address)).json(&body).send().await.unwrap();
    let reply: Value = reply.json().await.unwrap();
    let largest = &reply["crossland"]["largest"];
    let number = |value: &Value| value.as_f64().unwrap();
    let said = browser.value("document.querySelector('#verdict-crossland').innerText").await;
    let said = said.as_str().unwrap();
    assert!(said.contains(&format!("Largest {} MPa ± ", four(number(&largest["value"]) / 1e6))), "{said} {reply}");
    let margin = number(&reply["crossland"]["margin"]);
    assert!(margin < 1.0 && said.contains("the criterion predicts crack growth"), "{said}");
    assert!(said.contains(&format!("Margin {}", three(1000.0 * margin).parse::<f64>().unwrap() / 1000.0)), "{said}");
    // The warnings stand beside the result, in a colour that is not that of the text.
    let codes = reply["warnings"].as_array().unwrap().len();
    assert_eq!(browser.value("document.querySelectorAll('#crack-warnings li').length").await, codes);
    let colours = "['borderLeftColor', 'color'].map((name) => getComputedStyle(document.querySelector('#crack-warnings \
        li'))[name])";
    let colours = browser.value(colours).await;
    assert_ne!(colours[0], colours[1]);
    // The ring is at the worst place, which is on the surface, and whole.
    let mark = "(() => { const frame = document.querySelector('#plot-crack rect.field').getBBox(); \
                const ring = document.querySelector('#plot-crack .worst'); \
                return [(Number(ring.getAttribute('cx')) - frame.x) / frame.width, ring.getAttribute('cy') - frame.y]; \
                })()";
    let place: [f64; 2] = serde_json::from_value(browser.value(mark).await).unwrap();
    let half = (2.0 * number(&reply["contact"]["contact_radius"])).max(1.2 * number(&largest["point"][0]).abs());
    let expected = 0.5 + 0.5 * number(&largest["point"][0]) / half;
    assert!((place[0] - expected).abs() < 1e-3 && place[1] > 4.0, "{place:?} instead of {expected}");
    // No name is drawn over it.
    let clear = "(() => { const ring = document.querySelector('#plot-crack .worst').getBoundingClientRect(); \
                 return [...document.querySelectorAll('#plot-crack text.over')].every((text) => { \
                 const box = text.getBoundingClientRect(); return box.right < ring.left || box.left > ring.right || \
                 box.bottom < ring.top || box.top > ring.bottom; }); })()";
    assert_eq!(browser.value(clear).await, true);
    // The colours are smooth: their borders are no steps along the grid, but for the whole cells inside.
    let slanted = "[...document.querySelectorAll('#plot-crack .shade')].some((path) => \
                   path.getAttribute('d').split('Z').some((part) => part.slice(1).split('L').map((p) => \
                   p.split(',').map(Number)).some((p, index, all) => index > 0 && Math.abs(p[0] - all[index - 1][0]) > \
                   0.5 && Math.abs(p[1] - all[index - 1][1]) > 0.5)))";
    assert_eq!(browser.value(slanted).await, true);
    axe::assert_readable(&browser, "crack-found").await;
    browser.stayed_quiet_and_at(&server.address, &[]).await;
    browser.close().await;
}

#[tokio::test]
async fn the_frequency_response_is_drawn_with_its_backbone() {
    let server = Binary::start(&[]);
    let session = ball(&server).await;
    let browser = Browser::start(1280, 900, false).await;
    opened(&browser, &server, &session, "/damping").await;
    browser.click("#compute-response").await;
    browser.until("document.querySelector('#plot-response .line.now') !== null").await;
    // A kilogram on the stiffness 2 G* a of small motions.
    let figures = &session.contact;
    let natural = (2.0 * figures.g_star * figures.contact_radius).sqrt() / TAU;
    let said = "document.querySelector('#response-figures').innerText";
    browser.until(&format!("{said}.includes({:?})", format!("{} Hz", four(natural)))).await;
    let contact = crate::common::ball();
    let body = json!({"contact": contact, "drive": {"displacement": 1e-7},
        "frequency_response": {"mass": 1.0, "drive_force": 1.5}});
    let reply = reqwest::Client::new().post(format!("{}/cycle", server.address)).json(&body).send().await.unwrap();
    let reply: Value = reply.json().await.unwrap();
    let points = reply["frequency_response"]["points"].as_array().unwrap();
    let most = points.iter().map(|point| point["amplitude"].as_f64().unwrap()).fold(0.0, f64::max);
    let text = browser.value(said).await;
    assert!(text.as_str().unwrap().contains(&format!("{} nm at", four(most * 1e9))), "{text} {most}");
    for series in ["#plot-response .line.past", "#plot-backbone .line.work", "#plot-backbone .line.stored"] {
        let points =
            browser.value(&format!("document.querySelector({series:?}).getAttribute('d').split('L').length")).await;
        assert!(points.as_u64().unwrap() > 10, "{series}");
    }
    axe::assert_readable(&browser, "damping-found").await;
    browser.stayed_quiet_and_at(&server.address, &[]).await;
    browser.close().await;
}

#[tokio::test]
async fn damping_and_residual_stress_have_what_the_service_can_do() {
    let server = Binary::start(&[]);
    let session = ball(&server).await;
    let browser = Browser::start(1280, 900, false).await;
    let http = reqwest::Client::new();
    let asked = async |path: &str, body: &Value| -> Value {
        http.post(format!("{}{path}", server.address)).json(body).send().await.unwrap().json().await.unwrap()
    };
    let mut contact = crate::common::ball();
    contact["preload"] = json!({"indentation": session.contact.indentation});
    opened(&browser, &server, &session, "/damping").await;
    browser.click("#compute-study").await;
    let said = "document.querySelector('#study-figures').innerText.replaceAll('\\n', ' ')";
    let amplitude: f64 = format!("{:.2e}", 0.5 * session.contact.gross_slip_displacement).parse().unwrap();
    let drive = json!({"displacement": amplitude});
    let reply = asked("/cycle", &json!({"contact": contact, "drive": drive, "best_load": {}})).await;
    let best = reply["cycles"][0]["best_load"]["normal_force"].as_f64().unwrap();
    browser.until(&format!("{said}.includes({:?})", format!("Load that damps most {} N", four(best)))).await;
    browser.until("document.querySelector('#plot-density .line.work') !== null").await;
    browser.until("document.querySelector('#plot-best-load .line.work') !== null").await;
    // Under a load that oscillates the loss is another.
    browser.value("(document.querySelector('#study-card details').open = true) && null").await;
    let load = "document.querySelectorAll('#study-card details input')[0]";
    browser.value(&format!("({load}.value = '2') && null")).await;
    browser.click("#compute-study").await;
    browser.until("document.querySelector('#plot-density').hidden").await;
    let body = json!({"contact": contact, "drive": drive, "normal": {"normal_force": 2.0}});
    let loss = asked("/cycle", &body).await["cycles"][0]["loss_factor"].as_f64().unwrap();
    browser.until(&format!("{said}.includes({:?})", format!("Loss factor {loss:.4}").trim_end_matches('0'))).await;
    axe::assert_readable(&browser, "damping-study").await;

    opened(&browser, &server, &session, "/residual").await;
    browser.value("(document.querySelector('#search-card details').open = true) && null").await;
    let error = "document.querySelectorAll('#search-card details input')[0]";
    browser.value(&format!("({error}.value = '1') && null")).await;
    browser.click("#compute-search").await;
    let found = "document.querySelector('#search-figures').innerText.replaceAll('\\n', ' ')";
    let reply = asked("/protocols", &json!({"contact": contact, "target": 0.2})).await;
    browser.until(&format!("{found}.includes('Reversals {} ')", reply["reversals"])).await;
    browser.until(&format!("{found}.includes('In 95 of 100 trials at most')")).await;
    axe::assert_readable(&browser, "residual-search").await;
    browser.stayed_quiet_and_at(&server.address, &[]).await;
    browser.close().await;
}

#[tokio::test]
async fn a_contact_that_is_lifted_off_says_so() {
    let server = Binary::start(&[]);
    let session = ball(&server).await;
    moved(&server, &session, &[0.5]).await;
    let browser = Browser::start(1280, 900, false).await;
    opened(&browser, &server, &session, "").await;
    let said = "document.querySelector('.state-text').innerText";
    for lift in
        [Move { normal_force: Some(0.0), ..Move::default() }, Move { indentation: Some(-1e-8), ..Move::default() }]
    {
        server.client.apply(session.id, &MoveRequest::from(lift), &Options::default()).await.unwrap();
        browser.until(&format!("{said}.startsWith('Lifted off') && !{said}.includes('Stick')")).await;
        let press = Move { normal_force: Some(10.0), ..Move::default() };
        server.client.apply(session.id, &MoveRequest::from(press), &Options::default()).await.unwrap();
        browser.until(&format!("!{said}.includes('Lifted off')")).await;
    }
    browser.stayed_quiet_and_at(&server.address, &[]).await;
    browser.close().await;
}

#[tokio::test]
async fn the_axes_fit_the_recent_moves_and_all_are_a_key_away() {
    let server = Binary::start(&[]);
    let session = ball(&server).await;
    // A slip of the finger, and then a dozen moves about zero.
    moved(&server, &session, &[1e4]).await;
    let parts: Vec<f64> = (0..12).map(|index| 0.5 * f64::from(index % 3 - 1)).collect();
    moved(&server, &session, &parts).await;
    let browser = Browser::start(1280, 900, false).await;
    opened(&browser, &server, &session, "").await;
    // The widest displacement that a tick of the axis has, m.
    let unit = "document.querySelector('#plot-loop .title').textContent";
    browser.until(&format!("{unit} === 'Displacement U (nm)'")).await;
    let ticks = "[...document.querySelectorAll('#plot-loop .grid text')].map((text) => text.textContent.replace('−', \
                 '-')).map(Number).filter(Number.isFinite)";
    let widest = format!("Math.max(...{ticks}.map(Math.abs))");
    let slip = 1e9 * session.contact.gross_slip_displacement;
    let shown = browser.value(&widest).await.as_f64().unwrap();
    assert!(shown < 2.0 * slip, "{shown} nm, where gross slip begins at {slip} nm");
    browser.press("#plot-loop svg", "0").await;
    browser.until(&format!("{unit} === 'Displacement U (mm)'")).await;
    browser.stayed_quiet_and_at(&server.address, &[]).await;
    browser.close().await;
}

#[tokio::test]
async fn a_tooltip_names_its_values_and_does_not_cover_the_curve() {
    let server = Binary::start(&[]);
    let session = ball(&server).await;
    moved(&server, &session, &[0.9, -0.7, 0.5]).await;
    let browser = Browser::start(1280, 900, false).await;
    opened(&browser, &server, &session, "").await;
    browser.until("document.querySelector('#plot-loop .line.past')?.getAttribute('d').split('L').length > 20").await;
    let covered = "(() => { const box = document.querySelector('#plot-loop .cursor .label \
                   rect').getBoundingClientRect(); const way = document.querySelector('#plot-loop .line.past'); const \
                   at = way.getScreenCTM(); return Array.from({ length: 500 }, (_, index) => \
                   way.getPointAtLength(way.getTotalLength() * index / 499).matrixTransform(at)).filter((p) => p.x > \
                   box.left && p.x < box.right && p.y > box.top && p.y < box.bottom).length; })()";
    for part in [0.2, 0.35, 0.5, 0.65, 0.8] {
        browser.hover("#plot-loop svg", part).await;
        browser.until("document.querySelector('#plot-loop .cursor .label') !== null").await;
        assert_eq!(browser.value(covered).await, 0, "at {part} of the width");
    }
    // The same move in the other plot has its values with their names.
    let lines = browser.value("document.querySelector('#plot-work .said').textContent").await;
    let lines = lines.as_str().unwrap();
    assert!(lines.contains("friction work ") && lines.contains("stored "), "{lines}");
    browser.stayed_quiet_and_at(&server.address, &[]).await;
    browser.close().await;
}

#[tokio::test]
async fn all_faults_of_a_new_contact_are_shown_at_once_in_words() {
    let server = Binary::start(&[]);
    let browser = Browser::start(1280, 900, false).await;
    browser.page.goto(&format!("{}/#/new", server.address)).await.unwrap();
    let fields = "[...document.querySelectorAll('form .field')]";
    browser.until(&format!("{fields}.length > 4")).await;
    let write = |label: &str, text: &str| {
        format!(
            "(() => {{ const field = {fields}.find((one) => \
             one.querySelector('label').innerText.startsWith({label:?})); const input = field.querySelector('input'); \
             input.value = {text:?}; input.dispatchEvent(new Event('input', {{ bubbles: true }})); }})() ?? null"
        )
    };
    for (label, text) in [("Radius", "10 mm"), ("Coefficient", "-0.3"), ("Normal force", "")] {
        browser.value(&write(label, text)).await;
    }
    browser.click("#create").await;
    let fault = |label: &str| {
        format!(
            "{fields}.find((one) => \
                one.querySelector('label').innerText.startsWith({label:?})).querySelector('.fault').innerText"
        )
    };
    browser
        .until(&format!(
            "{} === 'This must be a number, without its unit and without separators of thousands.'",
            fault("Radius")
        ))
        .await;
    browser.until(&format!("{}.includes('out of range')", fault("Coefficient"))).await;
    browser.until(&format!("{} === 'A number is missing here.'", fault("Normal force"))).await;
    assert_eq!(server.client.contacts(None, None).await.unwrap().items.len(), 0);
    browser.picture("faults").await;
    browser.stayed_quiet_and_at(&server.address, &["status of 422"]).await;
    browser.close().await;
}

#[tokio::test]
async fn on_a_phone_the_controls_stay_in_reach() {
    let server = Binary::start(&[]);
    let session = ball(&server).await;
    let browser = Browser::start(390, 844, true).await;
    for tab in ["", "/crack", "/damping", "/residual"] {
        opened(&browser, &server, &session, tab).await;
        for part in [0.0, 0.4, 0.8] {
            browser
                .value(&format!("scrollTo(0, {part} * (document.documentElement.scrollHeight - innerHeight))"))
                .await;
            let reach = "(() => { const box = document.querySelector('#slide-displacement').getBoundingClientRect(); \
                         const hit = document.elementFromPoint((box.left + box.right) / 2, (box.top + box.bottom) / \
                         2); return box.top > 0 && box.bottom < innerHeight && hit.id === 'slide-displacement'; })()";
            browser.until(reach).await;
        }
    }
    // From the middle of the page, one move.
    browser.drag("#slide-displacement", 0.5, 0.9).await;
    let made = async || (server.client.contact(session.id).await.unwrap().sequence == 1).then_some(());
    until("the slider moves the contact", made).await;
    browser.stayed_quiet_and_at(&server.address, &[]).await;
    browser.close().await;
}

#[tokio::test]
async fn numbers_have_raised_powers() {
    let server = Binary::start(&[]);
    let session = ball(&server).await;
    moved(&server, &session, &[1e-4]).await;
    let browser = Browser::start(1280, 900, false).await;
    opened(&browser, &server, &session, "/damping").await;
    // The loss factor of so small a cycle on a ball is 1/(3 pi) of the amplitude over that of gross slip.
    let loss = 1e-4 / (3.0 * PI);
    let text = format!("{} × 10⁻⁵", four(loss * 1e5));
    browser.until(&format!("document.querySelector('#steady-figures').innerText.includes({text:?})")).await;
    assert_eq!(browser.value("document.body.innerText.includes('10^')").await, false);
    browser.stayed_quiet_and_at(&server.address, &[]).await;
    browser.close().await;
}

#[tokio::test]
async fn pictures_of_the_documentation() {
    let server = Binary::start(&[]);
    let session = ball(&server).await;
    moved(&server, &session, &[0.9, -0.7, 0.5, -0.3, 0.4]).await;
    let browser = Browser::start(1440, 1130, false).await;
    opened(&browser, &server, &session, "").await;
    browser.until("document.querySelectorAll('#plot-above .slipping').length === 1").await;
    browser.until("document.querySelector('#plot-loop .line.past')?.getAttribute('d').split('L').length > 20").await;
    // The warnings of the contact come last.
    browser.until("!document.querySelector('#warned').hidden").await;
    browser.picture("contact").await;
    opened(&browser, &server, &session, "/crack").await;
    let limit = "[...document.querySelectorAll('#crack-card fieldset')][0].querySelectorAll('input')[2]";
    browser.value(&format!("({limit}.value = '300') && null")).await;
    browser.click("#compute-crack").await;
    browser.until("document.querySelector('#plot-crack .shade') !== null").await;
    browser.picture("crack").await;
    browser.look(390, 844, false).await;
    opened(&browser, &server, &session, "").await;
    browser.until("document.querySelectorAll('#plot-loop .line').length === 2").await;
    browser.value("document.querySelector('#plot-loop').scrollIntoView() ?? null").await;
    browser.picture("narrow").await;
    browser.stayed_quiet_and_at(&server.address, &[]).await;
    browser.close().await;
}

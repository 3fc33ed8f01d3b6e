//! Line contacts on the page: the form with both specimens, the contact from the side, and stresses over x.

use serde_json::{Value, json};
use stickslip_wire::client::Options;
use stickslip_wire::{CreateRequest, Move, MoveRequest, NewSession};

use crate::axe;
use crate::browser::Browser;
use crate::scene::{LIVE, Scene};

/// Where the left and right edges of an element are in the field of its plot, from 0 to 1.
fn ends(plot: &str, part: &str) -> String {
    format!(
        "(() => {{ const [field, part] = ['.frame', {part:?}].map((css) => \
         document.querySelector('#plot-{plot} ' + css).getBoundingClientRect()); \
         return [part.left, part.right].map((x) => (x - field.left) / field.width); }})()"
    )
}

/// Asserts that an element of a plot reaches from one x to another, to two pixels of some three hundred; the plot
/// itself reaches from −reach to reach.
async fn assert_reaches(browser: &Browser, plot: &str, part: &str, expected: [f64; 2], reach: f64) {
    browser.find(&format!("#plot-{plot} {part}")).await;
    let found: [f64; 2] = serde_json::from_value(browser.value(&ends(plot, part)).await).unwrap();
    for (found, expected) in found.into_iter().zip(expected) {
        let expected = 0.5 * (1.0 + expected / reach);
        assert!((found - expected).abs() < 7e-3, "{plot} {part}: {found} {expected}");
    }
}

async fn create(scene: &Scene, request: Value) -> NewSession {
    let request: CreateRequest = serde_json::from_value(request).unwrap();
    scene.server.client.create(&request, &Options::default()).await.unwrap()
}

#[tokio::test]
async fn a_cylinder_with_bulk_stress_is_made_moved_and_seen_from_the_side() {
    let scene = Scene::start().await;
    let browser = &scene.browser;
    scene.view("new").await;
    browser.find("#create").await;
    for (label, value) in [
        ("Shape of the indenter", "cylinder"),
        ("Elasticity", "two"),
        ("Bulk stress along x that comes with the force", "second"),
    ] {
        browser.choose(label, value).await;
    }
    browser.counts("svg.specimen[role=img]", 1).await;
    browser.says(".derived", "Half-width a").await;
    let stress = "Bulk stress over the tangential force";
    browser.choose(stress, "1000000").await;
    let at_field = "[...document.querySelectorAll('.field')].find((field) => field.innerText.includes";
    browser.until(&format!("{at_field}({stress:?})).innerText.includes('too large')")).await;
    browser.choose(stress, "1200").await;
    browser.until(&format!("!{at_field}({stress:?})).innerText.includes('too large')")).await;
    assert_eq!(axe::serious(browser).await, [""; 0]);
    browser.picture("line-form").await;
    browser.click("#create").await;
    let id = scene.shown(None).await;
    let made = serde_json::to_value(scene.server.client.definition(id).await.unwrap()).unwrap();
    assert_eq!(made["profile"], json!({"type": "cylinder", "radius": 0.05, "length": 0.01}));
    assert_eq!(made["bulk"], json!({"body": "second", "stress_per_force": 1.2e6}));

    // Half of the friction limit on first loading, by Hertz and by Nowell & Hills.
    let (radius, length, load, kappa) = (0.05, 0.01, 10.0, 1.2e6);
    let compliance = (1.0 - 0.3 * 0.3) / 2.1e11;
    let edge = f64::sqrt(4.0 * radius * (load / length) * 2.0 * compliance / std::f64::consts::PI);
    let stick = edge * f64::sqrt(0.5);
    let centre = radius * compliance * kappa * load * 0.5;
    browser.write("#box-force", "1.5").await;
    browser.press("#box-force", "\u{e007}").await;
    browser.says(".side", "Partial slip").await;
    browser.says(".side", "Middle of the stick zone e").await;
    let state = scene.server.client.contact(id).await.unwrap().state;
    assert!((state.stick_centre.unwrap() / centre - 1.0).abs() < 1e-9, "{state:?} {centre}");
    browser.until("document.querySelectorAll('#plot-side .slipping').length === 2").await;
    let zone = [centre - stick, centre + stick];
    assert_reaches(browser, "stress", ".band.stick", zone, 1.04 * edge).await;
    for (part, expected) in [
        (".disc", [-edge, edge]),
        (".front", [zone[0]; 2]),
        (".front + .front", [zone[1]; 2]),
        (".middle", [centre; 2]),
    ] {
        assert_reaches(browser, "side", part, expected, 1.5 * edge).await;
    }
    // Tension of 1.8 MPa in the second body.
    browser.says("#plot-side", "bulk σ = 1.8 MPa").await;
    // What is under the pointer is marked in both plots.
    browser.hover("#plot-stress svg", 0.3).await;
    browser.find("#plot-side .cursor line").await;
    browser.hover("#plot-side svg", 0.5).await;
    browser.until("document.querySelector('#plot-side .cursor').textContent.includes('shear τ')").await;
    browser.find("#plot-stress .cursor line").await;
    assert_eq!(axe::serious(browser).await, [""; 0]);
    browser.picture("line-live").await;
    // The load stays, springs are of round contacts, and no path is searched for an eccentric zone.
    for absent in ["#plot-above", "#plot-accuracy", "#search-card", "#residual-card"] {
        browser.counts(absent, 0).await;
    }
    browser.until("document.querySelector('#box-load').offsetParent === null").await;
    browser.until("document.querySelectorAll('#protocol option').length === 1").await;

    // The worst place of the body that is pulled is the trailing edge.
    browser.click("#to-crack").await;
    browser.click("[name=crossland]").await;
    browser.click("[name=swt]").await;
    browser.click("#compute-crack").await;
    browser.says("#verdict-swt", &format!("on the surface, x = −{:.1} µm", 1e6 * edge)).await;
    browser.find("#plot-crack .mark.worst").await;
    // Friction dissipates more than the loop of the force.
    browser.click("#to-damping").await;
    browser.says("#steady-figures", "with the bulk stress").await;
    scene.end(&["status of 422"]).await;
}

#[tokio::test]
async fn a_pad_has_all_that_round_contacts_have_but_radii() {
    let scene = Scene::start().await;
    let browser = &scene.browser;
    let body = json!({"youngs_modulus": 7.4e10, "poisson_ratio": 0.33});
    let pad = create(
        &scene,
        json!({
            "label": "Pad",
            "profile": {"type": "rounded_pad", "flat_half_width": 5e-4, "edge_radius": 0.05, "length": 0.01},
            "material": {"bodies": [body, body]},
            "friction": 0.6,
            "preload": {"contact_radius": 8e-4},
        }),
    )
    .await;
    let limit = pad.contact.gross_slip_force;
    for part in [0.5, -0.3] {
        let step = MoveRequest::from(Move { force: Some(part * limit), ..Move::default() });
        scene.server.client.apply(pad.id, &step, &Options::default()).await.unwrap();
    }
    scene.open(&pad, "").await;
    browser.counts("#plot-side .slipping", 2).await;
    let stick = scene.server.client.contact(pad.id).await.unwrap().state.stick_radius;
    assert_reaches(browser, "side", ".front", [-stick; 2], 1.2e-3).await;
    assert_reaches(browser, "stress", ".band.stick", [-stick, stick], 1.04 * 8e-4).await;
    browser.counts("#plot-side .middle", 0).await;
    browser.picture("line-pad").await;
    // The extrema are drawn on both sides, the ends of the stick zone among them.
    let deepest = "(() => { const line = document.querySelector('#plot-stress .line.tau').getAttribute('d'); \
                   const places = line.slice(1).split('L').map((one) => one.split(',').map(Number)); \
                   const most = Math.max(...places.map((one) => one[1])); \
                   return places.filter((one) => one[1] === most).length; })()";
    assert_eq!(browser.value(deepest).await, 2);
    // Stresses over the radius do not belong into this plot.
    browser.click("#overlay summary").await;
    browser.until("document.querySelectorAll('#compare option').length === 2").await;
    browser.set("#compare", &scene.ball.id.to_string()).await;
    browser.until("document.querySelectorAll('#plot-loop .line.other').length === 1").await;
    browser.counts("#plot-stress .line.other", 0).await;

    scene.open(&pad, "/damping").await;
    browser.says("#steady-text", "a zone of the width").await;
    browser.click("#compute-study").await;
    browser.until("document.querySelector('#plot-density .title')?.textContent.startsWith('x, along')").await;
    browser.click("#to-residual").await;
    browser.write("#reversals", "3").await;
    browser.set("#protocol", "equal_peaks").await;
    browser.click("#run").await;
    browser.says("#run-status", "Now: up to").await;
    browser.click("#compute-search").await;
    browser.says("#search-figures", "Reversals").await;
    browser.until(LIVE).await;
    scene.end(&[]).await;
}

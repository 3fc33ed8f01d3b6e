//! Contacts of other laws on the page: bodies with memory, whose moves take their time, and a twist.

use stickslip_wire::Move;
use stickslip_wire::client::Options;

use crate::axe;
use crate::scene::{LIVE, Scene};

const ENTER: &str = "\u{e007}";
/// The drawn force over the time, `[x, y]` in pixels.
const FORCE: &str = "(document.querySelector('#plot-time .line.tau')?.getAttribute('d') ?? '')\
                     .slice(1).split('L').map((p) => p.split(',').map(Number))";

#[tokio::test]
async fn bodies_with_memory_are_made_moved_and_wait() {
    let scene = Scene::start().await;
    let (browser, client) = (&scene.browser, &scene.server.client);
    scene.view("new").await;
    browser.find("#create").await;
    browser.choose("Memory of the bodies", "prony").await;
    browser.click("#add-term").await;
    browser.choose("Ratio of term 2", "2").await;
    browser.until("document.querySelector('form.create').innerText.includes('out of range')").await;
    browser.choose("Ratio of term 2", "0,3").await;
    browser.until("!document.querySelector('form.create').innerText.includes('out of range')").await;
    assert_eq!(axe::serious(browser).await, [""; 0]);
    browser.picture("memory-form").await;
    browser.click("#create").await;
    let id = scene.shown(None).await;
    let terms = client.definition(id).await.unwrap().prony.unwrap();
    assert_eq!(terms.iter().map(|term| (term.ratio, term.time)).collect::<Vec<_>>(), [(0.4, 0.01), (0.3, 1.0)]);
    // What is refused of bodies with memory is not offered.
    browser.counts("nav.tabs a", 2).await;

    // A move takes its time, and a wait leaves what the series says of the force and of the load.
    browser.write("#box-displacement", "120").await;
    browser.press("#box-displacement", ENTER).await;
    browser.says(".side", "Time t 10 ms").await;
    let moved = client.contact(id).await.unwrap().state;
    browser.click("#wait").await;
    browser.says(".side", "Time t 1.01 s").await;
    let waited = client.contact(id).await.unwrap();
    let relaxed = |t: f64| 1.0 - 0.4 * -(-t / 0.01).exp_m1() - 0.3 * -(-t / 1.0).exp_m1();
    let load = waited.state.normal_force / 10.0;
    assert!((load / relaxed(1.01) - 1.0).abs() < 1e-6, "{load} {}", relaxed(1.01));
    assert_eq!(waited.state.indentation.to_bits(), moved.indentation.to_bits());
    // The force is followed through the wait: it falls at first, and hardly at last.
    browser
        .until(&format!(
            "(() => {{ const way = {FORCE}; const top = way.findIndex(([, y]) => y === Math.min(...way.map((p) => \
             p[1]))); const [from, to] = [way[top], way.at(-1)]; const middle = way.find(([x]) => x > (from[0] + \
             to[0]) / 2); return way.length > 20 && to[1] > from[1] + 20 && middle?.[1] > (from[1] + to[1]) / 2; }})()"
        ))
        .await;
    browser.says(".side", "Work of the bodies").await;
    browser.picture("memory").await;

    // With the load held the bodies approach.
    browser.click("#hold-load").await;
    browser.click("#wait").await;
    browser.says(".side", "Time t 2.01 s").await;
    let held = client.contact(id).await.unwrap().state;
    assert!((held.normal_force / waited.state.normal_force - 1.0).abs() < 1e-6, "{held:?}");
    assert!(held.indentation > moved.indentation, "{held:?}");
    // Without a number nothing waits.
    browser.choose("Wait for", "").await;
    browser.click("#wait").await;
    browser.says(".hands", "A number is missing here.").await;
    assert_eq!(client.contact(id).await.unwrap().sequence, 3);
    assert_eq!(axe::serious(browser).await, [""; 0]);
    scene.end(&["status of 422"]).await;
}

#[tokio::test]
async fn a_twist_is_seen_from_above_and_as_torque_over_angle() {
    let scene = Scene::start().await;
    let browser = &scene.browser;
    let twist = |angle| Move { twist: Some(angle), ..Move::default() };
    scene.apply(twist(1e-3)).await;
    scene.open(&scene.ball, "").await;
    let titles = "[...document.querySelectorAll('#plot-loop text.title')].map((one) => one.textContent).join()";
    browser.until(&format!("{titles}.includes('Angle of twist ω') && {titles}.includes('Torque M')")).await;
    browser.says(".side", "Angle ω 1 mrad").await;
    browser.says("#plot-above .note", "green anticlockwise").await;
    // No turning points are marked, and no direction of a motion.
    let said = format!("{} {}", browser.text("#plot-loop").await, browser.text("#plot-above").await);
    assert!(!said.contains("turning points") && !said.contains("along the motion"), "{said}");
    // The stuck disc has its part of the contact, and stripes lie around it.
    let part = "document.querySelector('#plot-above .front').r.baseVal.value / \
                document.querySelector('#plot-above .disc').r.baseVal.value";
    let shown = async || {
        browser.find("#plot-above .slipping").await;
        browser.value(part).await.as_f64().unwrap()
    };
    let state = scene.now().await.1;
    let expected = state.stick_radius / state.contact_radius;
    assert!(expected > 0.3 && expected < 0.95 && (shown().await / expected - 1.0).abs() < 1e-2, "{state:?}");
    // Twisted back, the torque returns along another way, past zero.
    scene.apply(twist(-1e-3)).await;
    browser.says(".side", "Angle ω −1 mrad").await;
    let state = scene.now().await.1;
    browser.until(&format!("Math.abs({part} - {}) < 1e-2", state.stick_radius / state.contact_radius)).await;
    let way = "(document.querySelector('#plot-loop .line.past')?.getAttribute('d') ?? '').slice(1).split('L')\
               .map((p) => p.split(',').map(Number))";
    browser
        .until(&format!(
            "(() => {{ const way = {way}; const top = way.findIndex(([x]) => x === Math.max(...way.map((p) => p[0]))); \
             const middle = (way[0][0] + way[top]?.[0]) / 2; const out = way.slice(0, top).find(([x]) => x >= middle); \
             const back = way.slice(top).find(([x]) => x <= middle); return back?.[1] > out?.[1] + 10; }})()"
        ))
        .await;
    browser.until(LIVE).await;
    browser.picture("twist").await;
    // Another client lifts it off, and shifts it: the axes are those of a shift again.
    let lifted = Move { indentation: Some(-1e-6), ..Move::default() };
    scene.apply(lifted).await;
    let pressed = Move { normal_force: Some(10.0), displacement: Some(5e-8), ..Move::default() };
    scene.server.client.apply(scene.ball.id, &pressed.into(), &Options::default()).await.unwrap();
    browser.until(&format!("{titles}.includes('Displacement U')")).await;
    scene.end(&[]).await;
}

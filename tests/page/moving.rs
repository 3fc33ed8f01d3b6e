//! Moving a contact by hand: units, what is sent and when, going back, and a service that is away for a while.

use serde_json::Value;
use stickslip_wire::client::Options;
use stickslip_wire::{Move, MoveRequest};
use tempfile::tempdir;

use crate::common::process::Process;
use crate::common::until;
use crate::hertz;
use crate::scene::{LIVE, Scene, WARNED};

const BOX: &str = "#box-displacement";
const SLIDER: &str = "#slide-displacement";
/// What will be sent.
const NOTE: &str = "document.querySelector('#to-send-displacement').innerText";
const FAULT: &str = "document.querySelector('#fault-displacement').innerText";
/// The number and the unit that the control shows.
const SHOWN: &str = "document.querySelector('#box-displacement').value + ' ' + \
                     document.querySelector('#unit-displacement').selectedOptions[0].textContent";
const ENTER: &str = "\u{e007}";
const ESCAPE: &str = "\u{e00c}";
const TAB: &str = "\u{e004}";
const LEFT: &str = "\u{e012}";
/// The drawn path of the loop, `[x, y]` in pixels; an empty one while the page draws it.
const WAY: &str = "(document.querySelector('#plot-loop .line.past')?.getAttribute('d') ?? \
    '').slice(1).split('L').map((p) => p.split(',').map(Number))";

#[tokio::test]
async fn an_empty_service_shows_an_example_and_makes_it_on_request() {
    let server = Process::with("memory:", &[]);
    let browser = crate::browser::Browser::start(1280, 900, false).await;
    browser.page.goto(&server.base).await.unwrap();
    // Like bodies have half the reduced modulus of one on a rigid plane; after 20 reversals 17.3 % remain (Kraft &
    // Pohrt).
    let expected = format!("contact radius {}", hertz(10.0, 0.01, 2.0));
    browser.says("#example", &expected).await;
    browser.says("#example", "keeps a shear stress of 17 % of μ p_max").await;
    assert!(server.client.contacts(None, None).await.unwrap().items.is_empty(), "the example stores nothing");
    browser.click("#open-example").await;
    browser.until(LIVE).await;
    let made = server.client.contacts(None, None).await.unwrap().items;
    let residual = reqwest::get(format!("{}/contacts/{}/residual", server.base, made[0].id)).await.unwrap();
    let left = residual.json::<Value>().await.unwrap()["relative"].as_f64().unwrap();
    assert!(made.len() == 1 && (left - 0.17335).abs() < 1e-4, "{left}");
    browser.page.goto(&format!("{}/#/", server.base)).await.unwrap();
    browser.says("body", "ball, 20 reversals of falling amplitude").await;
    browser.close().await;
}

#[tokio::test]
async fn a_contact_is_made_moved_reloaded_and_followed() {
    let server = Process::with("memory:", &[]);
    let browser = crate::browser::Browser::start(1280, 900, false).await;
    browser.page.goto(&server.base).await.unwrap();
    browser.says("body", "No contact yet").await;
    browser.click("#new").await;
    browser.write("input[maxlength]", "Steel ball").await;
    browser.click("#create").await;
    browser.until(LIVE).await;
    browser.until(WARNED).await;
    // Pulled to one side and back, the force returns along another path.
    browser.drag(SLIDER, 0.5, 0.8).await;
    browser.until(&format!("{WAY}.length > 5")).await;
    browser.drag(SLIDER, 0.8, 0.35).await;
    let turned = format!(
        "(() => {{ const way = {WAY}; const x = way.map((p) => p[0]); const top = x.indexOf(Math.max(...x)); \
         const middle = (x[0] + x[top]) / 2; const out = way.slice(0, top).find((p) => p[0] >= middle); \
         const back = way.slice(top).find((p) => p[0] <= middle); \
         return out !== undefined && back !== undefined && x.at(-1) < x[0] && back[1] > out[1] + 10; }})()"
    );
    browser.until(&turned).await;
    let id = server.client.contacts(None, None).await.unwrap().items[0].id;
    // The last moves of the slider may still be under way.
    until("the page shows what the server has", async || {
        let force = server.client.contact(id).await.unwrap().state.force.unwrap();
        let shown = browser.value("Number(document.querySelector('#box-force').value)").await;
        ((shown.as_f64().unwrap() - force).abs() < 1e-4).then_some(())
    })
    .await;
    // The history is still there after a reload.
    let moves = server.client.contact(id).await.unwrap().sequence;
    browser.page.refresh().await.unwrap();
    browser.until(LIVE).await;
    browser.until(&turned).await;
    browser.until(&format!("{WAY}.length > {moves}")).await;
    assert_eq!(browser.text("h1").await, "Steel ball");
    // Moves by another client are shown at once.
    let step = Move { normal_force: Some(15.0), displacement: Some(5e-8), ..Move::default() };
    server.client.apply(id, &MoveRequest::from(step), &Options::default()).await.unwrap();
    browser.until("document.querySelector('#box-displacement').value === '50'").await;
    browser.says(".side", &hertz(15.0, 0.01, 2.0)).await;
    server.client.delete(id, &Options::default()).await.unwrap();
    browser.says(".badge", "deleted").await;
    // What was asked of the contact while it was deleted is logged.
    browser.stayed_quiet_and_at(&server.base, &["status of 404"]).await;
    browser.close().await;
}

#[tokio::test]
async fn a_typed_number_keeps_its_unit_and_is_shown_before_it_is_sent() {
    let scene = Scene::start().await;
    let browser = &scene.browser;
    let sent =
        async |sequence| until("the move is made", async || (scene.now().await.0 == sequence).then_some(())).await;
    scene.open(&scene.ball, "").await;
    browser.until(&format!("({SHOWN}) === '0 nm (auto)'")).await;
    for (typed, sequence, metres, si, micro) in
        [("5000", 1, 5e-6, "0.000005", "5"), ("4900", 2, 4.9e-6, "0.0000049", "4.9")]
    {
        browser.write(BOX, typed).await;
        browser.until(&format!("{NOTE} === 'Enter sends {typed} nm = {si} m.'")).await;
        assert_eq!(scene.now().await.0, sequence - 1, "nothing is sent while the user types");
        browser.press(BOX, ENTER).await;
        browser.says(".side", &format!("Displacement U {micro} µm")).await;
        let (made, state) = scene.now().await;
        assert_eq!((made, state.displacement), (sequence, Some(metres)));
        browser.until(&format!("({SHOWN}) === '{typed} nm' && {NOTE} === ''")).await;
    }
    // Another unit shows the same displacement, and stays too.
    browser.set("#unit-displacement", "-6").await;
    browser.until(&format!("({SHOWN}) === '4.9 µm'")).await;
    browser.write(BOX, "0,1").await;
    browser.until(&format!("{NOTE} === 'Enter sends 0,1 µm = 1e-7 m.'")).await;
    // Escape sends nothing.
    browser.press(BOX, ESCAPE).await;
    browser.until(&format!("({SHOWN}) === '4.9 µm' && {NOTE} === ''")).await;
    // One comma before three digits may separate thousands or decimals: the page asks, and sends nothing.
    browser.write(BOX, "1,000").await;
    browser.press(BOX, ENTER).await;
    browser.until(&format!("{FAULT} === 'Write 1.000 or 1000: 1,000 may be either.'")).await;
    // Nor does a number that is left without Enter move the contact.
    browser.write(BOX, "1.000").await;
    browser.until(&format!("{NOTE} === 'Enter sends 1.000 µm = 0.000001 m.' && {FAULT} === ''")).await;
    browser.press(SLIDER, ESCAPE).await;
    browser.press(BOX, ESCAPE).await;
    browser.until(&format!("({SHOWN}) === '4.9 µm'")).await;
    assert_eq!(scene.now().await.0, 2);

    // A slider sends once, where it is let go.
    browser.drag(SLIDER, 0.97, 0.6).await;
    sent(3).await;
    let (_, state) = scene.now().await;
    assert!(state.displacement.is_some_and(|u| u > 0.0 && u < 4e-6), "{state:?}");
    // By keyboard it sends by Enter, however many keys it takes to get there.
    browser.press(SLIDER, &LEFT.repeat(3)).await;
    browser.until(&format!("{NOTE}.startsWith('Enter sends ')")).await;
    assert_eq!(scene.now().await.0, 3, "no key of the slider sends");
    browser.press(SLIDER, ESCAPE).await;
    browser.until(&format!("{NOTE} === ''")).await;
    browser.press(SLIDER, &(LEFT.repeat(3) + ENTER)).await;
    sent(4).await;

    // A move far beyond slip is asked for before it is sent. A tenth of the radius is 1 mm, and what is not farther is
    // sent unasked. By keyboard alone: Escape and Enter take it back, and Tab leads to the button that sends it.
    let open = "document.querySelector('#far').open";
    browser.write(BOX, "999").await;
    browser.press(BOX, ENTER).await;
    sent(5).await;
    for (typed, answer) in [("1e9", vec![ESCAPE]), ("1e9", vec![ENTER]), ("1001", vec![TAB, ENTER])] {
        browser.write(BOX, typed).await;
        browser.press(BOX, ENTER).await;
        browser.until(open).await;
        browser.says("#far-text", "over 100 times that of gross slip").await;
        browser.picture("far").await;
        assert_eq!(scene.now().await.0, 5, "nothing is sent while the page asks");
        for key in &answer {
            browser.press("#far :focus", key).await;
        }
        browser.until(&format!("!{open}")).await;
        if answer.len() == 1 {
            browser.until(&format!("{FAULT} === 'Not sent.'")).await;
            browser.until(&format!("document.activeElement === document.querySelector({BOX:?})")).await;
            assert_eq!(browser.value(&format!("document.querySelector({BOX:?}).value")).await, typed);
        }
    }
    sent(6).await;
    let (sequence, state) = scene.now().await;
    assert_eq!((sequence, state.displacement), (6, Some(1.001e-3)));

    // A fault goes when the state has changed otherwise, and the number with it.
    scene.moved(&[0.5]).await;
    browser.write("#box-force", "50").await;
    browser.press("#box-force", ENTER).await;
    browser.says("#fault-force", "friction holds no more").await;
    browser.until("document.querySelector('#box-force').value === '50'").await;
    browser.picture("fault").await;
    scene.moved(&[0.0]).await;
    browser.until("document.querySelector('#fault-force').innerText === ''").await;
    let box_is_clean = "Math.abs(Number(document.querySelector('#box-force').value)) < 3.1 && \
                        !document.querySelector('#box-force').hasAttribute('aria-invalid')";
    browser.until(box_is_clean).await;
    scene.end(&["status of 422"]).await;
}

#[tokio::test]
async fn undo_goes_back_by_a_fork_and_a_name_changes_in_place() {
    let scene = Scene::over(Process::with("memory:", &[]), 400, 850, true).await;
    let browser = &scene.browser;
    scene.moved(&[0.9, -0.7, 0.5]).await;
    let path = scene.server.client.history(scene.ball.id, None, None).await.unwrap().items;
    scene.open(&scene.ball, "").await;
    browser.until("!document.querySelector('#undo').disabled").await;
    let mut before = scene.ball.id;
    for (act, sequence) in [("#undo", 2), ("#undo", 1), ("#go-back", 0)] {
        browser.click(act).await;
        before = scene.shown(Some(before)).await;
        let now = scene.server.client.contact(before).await.unwrap();
        assert_eq!(now.sequence, sequence, "{act}");
        let expected = usize::try_from(sequence).unwrap().checked_sub(1).map(|last| path[last].state);
        assert_eq!(now.state, expected.unwrap_or(scene.ball.state));
        // It looks like the same contact, and the page says that it is a copy.
        assert_eq!(browser.text("h1").await, "Steel ball");
        browser.says("#notice", "a copy of the same name").await;
    }
    browser.until("document.querySelector('#undo').disabled").await;
    assert_eq!(scene.now().await.0, 3, "the original keeps its moves");

    browser.click("#rename").await;
    browser.write(".rename input", "Ball, before it moved").await;
    browser.press(".rename input", ENTER).await;
    browser.says("h1", "Ball, before it moved").await;
    browser.until("document.documentElement.scrollWidth <= innerWidth").await;
    let named = scene.server.client.contact(before).await.unwrap();
    assert_eq!((named.label.as_deref(), named.sequence), (Some("Ball, before it moved"), 0));
    scene.view("").await;
    browser.says(".list", "Ball, before it moved").await;
    scene.end(&[]).await;
}

#[tokio::test]
async fn a_service_that_is_away_is_named_and_the_page_goes_on_when_it_is_back() {
    let folder = tempdir().unwrap();
    let store = format!("sqlite:{}", folder.path().join("contacts.db").display());
    let mut scene = Scene::over(Process::with(&store, &[]), 1280, 900, false).await;
    scene.moved(&[0.5]).await;
    scene.open(&scene.ball, "").await;
    scene.server.signal("KILL");
    let away = "!document.querySelector('#away').hidden";
    scene.browser.until(&format!("{away} && !({LIVE})")).await;
    // A move is not repeated unasked, and says why it failed.
    scene.browser.write(BOX, "50").await;
    scene.browser.press(BOX, ENTER).await;
    scene.browser.says("#fault-displacement", "The service does not answer").await;
    scene.browser.picture("away").await;
    // A view that is opened meanwhile is shown when the service is back.
    scene.browser.value("location.assign('#/') ?? null").await;
    scene.browser.says("main", "Loading").await;
    let address = scene.server.base.strip_prefix("http://").unwrap().to_owned();
    scene.server = Process::at(&address, &store, &[]);
    let browser = &scene.browser;
    browser.until(&format!("!({away})")).await;
    browser.says(".list strong", "Steel ball").await;
    browser.click(".list a").await;
    browser.until(LIVE).await;
    assert_eq!(scene.now().await.0, 1, "the move that failed was not made later");
    scene.moved(&[0.0]).await;
    browser.until("document.querySelector('#box-displacement').value === '0'").await;
    let text: Value = browser.value("document.body.innerText").await;
    assert!(!text.as_str().unwrap().contains("Failed to fetch"), "{text}");
    scene.end(&["ERR_CONNECTION", "ERR_INCOMPLETE", "ERR_EMPTY", "network error"]).await;
}

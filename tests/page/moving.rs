//! Moving a contact by hand: units, what is sent and when, going back, and a service that is away for a while.

use serde_json::{Value, json};
use stickslip_wire::client::Options;
use tempfile::tempdir;

use crate::browser::Browser;
use crate::common::{Binary, create, until};
use crate::{E_STAR, ball, hertz, moved};

/// The number and the unit that a control shows.
fn shown(name: &str) -> String {
    format!(
        "document.querySelector('#box-{name}').value + ' ' + \
         document.querySelector('#unit-{name}').selectedOptions[0].textContent"
    )
}

/// What a control says is wrong.
fn fault(name: &str) -> String {
    format!("document.querySelector('#fault-{name}').innerText")
}

async fn displacement(server: &Binary, session: &stickslip_wire::NewSession) -> (u64, f64) {
    let now = server.client.contact(session.id).await.unwrap();
    (now.sequence, now.state.displacement)
}

#[tokio::test]
async fn a_typed_number_keeps_its_unit_and_is_shown_before_it_is_sent() {
    let server = Binary::start(&[]);
    let session = ball(&server).await;
    let browser = Browser::start(1280, 900, false).await;
    browser.page.goto(&format!("{}/#/contacts/{}", server.address, session.id)).await.unwrap();
    let live = "document.querySelector('.badge.on') !== null";
    browser.until(&format!("{live} && ({}) === '0 nm (auto)'", shown("displacement"))).await;
    let note = "document.querySelector('#to-send-displacement').innerText";
    for (typed, sequence, metres, si, micro) in
        [("5000", 1, 5e-6, "0.000005", "5"), ("4900", 2, 4.9e-6, "0.0000049", "4.9")]
    {
        browser.write("#box-displacement", typed).await;
        browser.until(&format!("{note} === 'Enter sends {typed} nm = {si} m.'")).await;
        assert_eq!(displacement(&server, &session).await.0, sequence - 1, "nothing is sent while one types");
        browser.press("#box-displacement", "\u{e007}").await;
        browser.until(&format!("document.querySelector('.side').innerText.includes('\\n{micro} µm')")).await;
        assert_eq!(displacement(&server, &session).await, (sequence, metres));
        browser.until(&format!("({}) === '{typed} nm' && {note} === ''", shown("displacement"))).await;
    }
    // Another unit shows the same displacement, and stays too.
    let choose = "(() => { const unit = document.querySelector('#unit-displacement'); unit.value = '-6'; \
                  unit.dispatchEvent(new Event('change')); })() ?? null";
    browser.value(choose).await;
    browser.until(&format!("({}) === '4.9 µm'", shown("displacement"))).await;
    browser.write("#box-displacement", "0,1").await;
    browser.until(&format!("{note} === 'Enter sends 0,1 µm = 1e-7 m.'")).await;
    // Escape sends nothing.
    browser.press("#box-displacement", "\u{e00c}").await;
    browser.until(&format!("({}) === '4.9 µm' && {note} === ''", shown("displacement"))).await;
    assert_eq!(displacement(&server, &session).await.0, 2);

    // One comma before three digits may separate thousands or decimals: the page asks, and sends nothing.
    browser.write("#box-displacement", "1,000").await;
    browser.press("#box-displacement", "\u{e007}").await;
    browser.until(&format!("{} === 'Write 1.000 or 1000: 1,000 may be either.'", fault("displacement"))).await;
    // Nor does a number that is left without Enter move the contact.
    browser.write("#box-displacement", "1.000").await;
    browser
        .until(&format!("{note} === 'Enter sends 1.000 µm = 0.000001 m.' && {} === ''", fault("displacement")))
        .await;
    browser.press("#slide-displacement", "\u{e00c}").await;
    browser.press("#box-displacement", "\u{e00c}").await;
    browser.until(&format!("({}) === '4.9 µm'", shown("displacement"))).await;
    assert_eq!(displacement(&server, &session).await.0, 2);

    // A slider sends once, where it is let go.
    browser.drag("#slide-displacement", 0.97, 0.6).await;
    browser
        .until(
            "document.querySelector('#plot-work .said') && \
        !document.querySelector('.side').innerText.includes('4.9 µm')",
        )
        .await;
    let (sequence, dragged) = displacement(&server, &session).await;
    assert_eq!(sequence, 3);
    assert!(dragged > 0.0 && dragged < 4e-6, "{dragged}");
    // By keyboard it sends by Enter, however many keys it takes to get there.
    browser.press("#slide-displacement", "\u{e012}\u{e012}\u{e012}").await;
    browser.until(&format!("{note}.startsWith('Enter sends ')")).await;
    assert_eq!(displacement(&server, &session).await.0, 3, "no key of the slider sends");
    browser.press("#slide-displacement", "\u{e00c}").await;
    browser.until(&format!("{note} === ''")).await;
    browser.press("#slide-displacement", "\u{e012}\u{e012}\u{e012}\u{e007}").await;
    let sent = async || (displacement(&server, &session).await.0 == 4).then_some(());
    until("Enter moves the contact", sent).await;

    // A fault goes when the state has changed otherwise, and the number with it.
    let fault = fault("force");
    browser.write("#box-force", "50").await;
    browser.press("#box-force", "\u{e007}").await;
    browser
        .until(&format!(
            "{fault}.includes('friction holds no more') && document.querySelector('#box-force').value === '50'"
        ))
        .await;
    browser.picture("fault").await;
    moved(&server, &session, &[0.0]).await;
    let force = "Number(document.querySelector('#box-force').value)";
    browser
        .until(&format!(
            "{fault} === '' && Math.abs({force}) < 3.1 && \
        !document.querySelector('#box-force').hasAttribute('aria-invalid')"
        ))
        .await;
    browser.stayed_quiet_and_at(&server.address, &["status of 422"]).await;
    browser.close().await;
}

#[tokio::test]
async fn every_field_asks_what_a_comma_before_three_digits_separates() {
    let server = Binary::start(&[]);
    let session = ball(&server).await;
    moved(&server, &session, &[0.9, -0.7]).await;
    let browser = Browser::start(1280, 900, false).await;
    browser.page.goto(&format!("{}/#/new", server.address)).await.unwrap();
    browser.find("form.create input[inputmode=decimal]").await;
    let boxes = "[...document.querySelectorAll('form.create .field input[inputmode=decimal]')]";
    let faults = format!("{boxes}.map((box) => box.closest('.field').querySelector('.fault').innerText)");
    for (typed, question) in [
        ("1,000", "Write 1.000 or 1000: 1,000 may be either."),
        ("−12,345e-3", "Write -12.345e-3 or -12345e-3: -12,345e-3 may be either."),
        ("1,000,000", "This must be a number, without its unit and without separators of thousands."),
        ("1.000,5", "This must be a number, without its unit and without separators of thousands."),
    ] {
        let write = format!(
            "{boxes}.map((box) => {{ box.value = {typed:?}; \
             box.dispatchEvent(new Event('input', {{ bubbles: true }})); }}).length"
        );
        assert_eq!(browser.value(&write).await, 5);
        browser.until(&format!("{faults}.every((fault) => fault === {question:?})")).await;
    }
    browser.click("#create").await;
    // These are one number each: thousands have three digits in a group, and no group begins with 0.
    browser.write("form .card:first-child input", "12,5").await;
    let figures = "document.querySelector('.derived').innerText";
    for (at, typed) in [(1, "210"), (2, "0,300"), (3, "0,3"), (4, "1000,000e-2")] {
        browser.value(&format!("{boxes}[{at}].focus() ?? null")).await;
        browser.value(&format!("{boxes}[{at}].select() ?? null")).await;
        browser.page.active_element().await.unwrap().send_keys(typed).await.unwrap();
    }
    browser.until(&format!("{figures}.includes({:?})", hertz(10.0, 0.0125, E_STAR))).await;
    assert_eq!(server.client.contacts(None, None).await.unwrap().items.len(), 1, "the form waited for an answer");

    let contact = format!("{}/#/contacts/{}", server.address, session.id);
    for (tab, field, act, said) in
        [("/residual", "#reversals", "#run", "#run-status"), ("", "#back-to", "#go-back", "#notice")]
    {
        browser.page.goto(&format!("{contact}{tab}")).await.unwrap();
        browser.until("document.querySelector('.badge.on') !== null").await;
        browser.write(field, "1,000").await;
        browser.click(act).await;
        browser.until(&format!("document.querySelector('{said}').innerText.endsWith('1,000 may be either.')")).await;
        // No number is read by the language of the browser.
        assert_eq!(browser.value("document.querySelectorAll('input[type=number]').length").await, 0);
    }
    assert_eq!(displacement(&server, &session).await.0, 2);
    assert_eq!(server.client.contacts(None, None).await.unwrap().items.len(), 1);
    browser.stayed_quiet_and_at(&server.address, &["status of 422"]).await;
    browser.close().await;
}

#[tokio::test]
async fn a_move_far_beyond_slip_is_asked_for_before_it_is_sent() {
    let server = Binary::start(&[]);
    let session = ball(&server).await;
    let browser = Browser::start(1280, 900, false).await;
    browser.page.goto(&format!("{}/#/contacts/{}", server.address, session.id)).await.unwrap();
    browser.until("document.querySelector('.badge.on') !== null").await;
    let choose = "(() => { const unit = document.querySelector('#unit-displacement'); unit.value = '-6'; \
                  unit.dispatchEvent(new Event('change')); })() ?? null";
    browser.value(choose).await;
    let (open, fault) =
        ("document.querySelector('#far').open", "document.querySelector('#fault-displacement').innerText");
    // A tenth of the radius is 1 mm, and what is not farther is sent unasked.
    for (typed, answer, sequence) in [
        ("999", None, 1),
        ("1e9", Some("\u{e00c}"), 1),
        ("1e9", Some("\u{e007}"), 1),
        ("1001", Some("\u{e004}\u{e007}"), 2),
    ] {
        browser.write("#box-displacement", typed).await;
        browser.press("#box-displacement", "\u{e007}").await;
        if let Some(keys) = answer {
            browser.until(open).await;
            browser.picture("far").await;
            assert!(displacement(&server, &session).await.0 < 2, "nothing is sent while the page asks");
            // By keyboard alone: Escape and Enter take it back, and Tab leads to the button that sends it.
            for key in keys.chars() {
                browser.press("#far :focus", &key.to_string()).await;
            }
            browser.until(&format!("!{open}")).await;
        }
        if answer.is_some() && sequence == 1 {
            browser.until(&format!("{fault} === 'Not sent.'")).await;
            browser.until("document.activeElement === document.querySelector('#box-displacement')").await;
            assert_eq!(browser.value("document.querySelector('#box-displacement').value").await, typed);
        } else {
            let sent = async || (displacement(&server, &session).await.0 == sequence).then_some(());
            until("the move is sent", sent).await;
        }
    }
    assert_eq!(displacement(&server, &session).await, (2, 1.001e-3));
    browser.stayed_quiet_and_at(&server.address, &[]).await;
    browser.close().await;
}

#[tokio::test]
async fn undo_goes_back_by_a_fork_and_a_name_changes_in_place() {
    let server = Binary::start(&[]);
    let session = ball(&server).await;
    moved(&server, &session, &[0.9, -0.7, 0.5]).await;
    let path = server.client.history(session.id, None, None).await.unwrap().items;
    let browser = Browser::start(400, 850, true).await;
    browser.page.goto(&format!("{}/#/contacts/{}", server.address, session.id)).await.unwrap();
    let live = "document.querySelector('.badge.on') !== null";
    browser.until(&format!("{live} && !document.querySelector('#undo').disabled")).await;
    let mut before = session.id;
    for (act, sequence) in [("#undo", 2), ("#undo", 1), ("#go-back", 0)] {
        browser.click(act).await;
        browser.until(&format!("!location.hash.includes('{before}') && {live}")).await;
        let hash = browser.value("location.hash").await;
        before = hash.as_str().unwrap().rsplit('/').next().unwrap().parse().unwrap();
        let now = server.client.contact(before).await.unwrap();
        assert_eq!(now.sequence, sequence, "{act}");
        let expected = usize::try_from(sequence).unwrap().checked_sub(1).map(|last| path[last].state);
        assert_eq!(now.state, expected.unwrap_or(session.state));
        // It looks like the same contact, and the page says that it is a copy.
        assert_eq!(browser.value("document.querySelector('h1').innerText").await, "Steel ball");
        let said = browser.value("document.querySelector('#notice').innerText").await;
        assert!(said.as_str().unwrap().contains("a copy of the same name"), "{said}");
    }
    browser.until("document.querySelector('#undo').disabled").await;
    assert_eq!(server.client.contact(session.id).await.unwrap().sequence, 3, "the original keeps its moves");

    browser.click("#rename").await;
    browser.write(".rename input", "Ball, before it moved").await;
    browser.picture("rename").await;
    browser.press(".rename input", "\u{e007}").await;
    browser.until("document.querySelector('h1').innerText === 'Ball, before it moved'").await;
    browser.until("document.documentElement.scrollWidth <= innerWidth").await;
    let named = server.client.contact(before).await.unwrap();
    assert_eq!((named.label.as_deref(), named.sequence), (Some("Ball, before it moved"), 0));
    browser.page.goto(&format!("{}/#/", server.address)).await.unwrap();
    browser
        .until(
            "[...document.querySelectorAll('.list strong')].some((name) => name.innerText === 'Ball, before it moved')",
        )
        .await;
    browser.picture("list").await;
    browser.stayed_quiet_and_at(&server.address, &[]).await;
    browser.close().await;
}

#[tokio::test]
async fn a_service_that_is_away_is_named_and_the_page_goes_on_when_it_is_back() {
    let folder = tempdir().unwrap();
    let store = format!("sqlite:{}", folder.path().join("contacts.db").display());
    let mut server = Binary::over(&store, &[]);
    let session = ball(&server).await;
    moved(&server, &session, &[0.5]).await;
    let browser = Browser::start(1280, 900, false).await;
    browser.page.goto(&format!("{}/#/contacts/{}", server.address, session.id)).await.unwrap();
    let live = "document.querySelector('.badge.on') !== null";
    browser.until(live).await;
    server.child.kill().unwrap();
    server.child.wait().unwrap();
    let away = "!document.querySelector('#away').hidden";
    browser.until(&format!("{away} && !({live})")).await;
    // A move is not repeated unasked, and says why it failed.
    browser.write("#box-displacement", "50").await;
    browser.press("#box-displacement", "\u{e007}").await;
    browser
        .until("document.querySelector('#fault-displacement').innerText.startsWith('The service does not answer')")
        .await;
    browser.picture("away").await;
    // A view that is opened meanwhile is shown when the service is back.
    browser.value("location.assign('#/') ?? null").await;
    browser.until("document.querySelector('main').innerText.includes('Loading')").await;
    let address = server.address.strip_prefix("http://").unwrap().to_owned();
    let server = Binary::at(&address, &store, &[]);
    browser.until(&format!("!({away}) && document.querySelector('.list strong')?.innerText === 'Steel ball'")).await;
    browser.click(".list a").await;
    browser.until(live).await;
    let before = server.client.contact(session.id).await.unwrap();
    assert_eq!(before.sequence, 1, "the move that failed was not made later");
    moved(&server, &session, &[0.0]).await;
    browser.until("document.querySelector('#box-displacement').value === '0'").await;
    let text: Value = browser.value("document.body.innerText").await;
    assert!(!text.as_str().unwrap().contains("Failed to fetch"), "{text}");
    browser
        .stayed_quiet_and_at(&server.address, &["ERR_CONNECTION", "ERR_INCOMPLETE", "ERR_EMPTY", "network error"])
        .await;
    browser.close().await;
}

#[tokio::test]
async fn the_largest_shear_stress_and_the_warnings_are_in_sight() {
    let server = Binary::start(&[]);
    let mut request = create();
    // Equal bodies with Poisson's ratio zero: no warning is due.
    let body = json!({"youngs_modulus": 2.1e11, "poisson_ratio": 0.0});
    request.material = serde_json::from_value(json!({"bodies": [body, body]})).unwrap();
    let quiet = server.client.create(&request, &Options::default()).await.unwrap();
    assert!(quiet.warnings.is_empty(), "{:?}", quiet.warnings);
    let warned = ball(&server).await;
    let browser = Browser::start(1280, 900, false).await;
    let said = "document.querySelector('.state-text').innerText.replaceAll('\\n', '')";
    for session in [&quiet, &warned] {
        browser.page.goto(&format!("{}/#/contacts/{}", server.address, session.id)).await.unwrap();
        let count = format!("document.querySelectorAll('#warnings li').length === {}", session.warnings.len());
        browser
            .until(&format!(
                "document.querySelector('#trust-card summary')?.innerText.startsWith('Accuracy') && \
            document.querySelector('#trust-card dd') !== null && {count}"
            ))
            .await;
        browser.until(&format!("{said}.includes('Largest shear stress0 Pa = 0 % of μ p')")).await;
        // After gross slip it is the whole of it; back at zero sqrt(1/2).
        let full = 0.3 * session.contact.max_pressure.unwrap();
        for (part, share) in [(1.5, 1.0), (0.5, 0.5_f64.sqrt())] {
            // One reversal from gross slip by the displacement of gross slip brings it to the middle.
            moved(&server, session, &[part]).await;
            let text = format!(
                "Largest shear stress{} = {} % of μ p",
                four_pascals(full * share),
                crate::three(100.0 * share)
            );
            browser.until(&format!("{said}.includes({text:?})")).await;
        }
    }
    browser.value("(document.querySelector('#trust-card').open = true) && null").await;
    browser.picture("trust").await;
    browser.stayed_quiet_and_at(&server.address, &[]).await;
    browser.close().await;
}

/// Four digits in MPa or GPa, as the page shows them.
fn four_pascals(value: f64) -> String {
    if value >= 1e9 { format!("{} GPa", crate::four(value / 1e9)) } else { format!("{} MPa", crate::four(value / 1e6)) }
}

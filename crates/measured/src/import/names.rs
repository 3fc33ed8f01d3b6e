//! What the name of a column means: the words of instruments and laboratories, in English and German, with
//! the plainest of other languages.

/// What a column holds, by its name. A rank orders names that fit less and less.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Meaning {
    /// The number of a row, a sample or a cycle.
    Index,
    /// A ratio of forces.
    Coefficient,
    /// What was asked of the machine.
    Command,
    /// A velocity, a frequency or another rate.
    Rate,
    /// An error, a largest value or another figure of many points.
    Statistic,
    /// Temperatures, electrical quantities and texts.
    Other,
    /// A time or a date.
    Time,
    /// A force across the surface.
    Load,
    /// A force along it.
    Force(u8),
    /// `Friction`, which may be a force or a coefficient.
    Friction,
    /// A displacement across the surface: depth, wear, approach.
    Depth,
    /// A way that only grows.
    Distance,
    /// A displacement along the surface.
    Displacement(u8),
    /// None of these.
    Unknown,
}

impl Meaning {
    /// Why a column of this meaning is left out where nobody asked for it.
    pub(super) fn reason(self) -> &'static str {
        match self {
            Meaning::Index => "a number of rows or cycles",
            Meaning::Coefficient => "a coefficient",
            Meaning::Command => "a command or set point",
            Meaning::Rate => "a rate",
            Meaning::Statistic => "a figure of many points",
            Meaning::Depth => "a depth",
            Meaning::Distance => "a distance that adds up",
            Meaning::Friction => "may be a coefficient",
            _ => "not needed",
        }
    }
}

/// A name in lower case, as words and without what separates them. `FrictionForce` is two words.
struct Words {
    joined: String,
    words: Vec<String>,
}

/// Letters with marks, and those without that stand for them.
const FOLDED: [(&str, &str); 14] = [
    ("àáâãåąÀÁÂÃÅĄ", "a"),
    ("çćčÇĆČ", "c"),
    ("èéêëęěÈÉÊËĘĚ", "e"),
    ("ìíîïıİÌÍÎÏ", "i"),
    ("ñńňÑŃŇ", "n"),
    ("òóôõøÒÓÔÕØ", "o"),
    ("ùúûůÙÚÛŮ", "u"),
    ("śšşŚŠŞ", "s"),
    ("źżžŹŻŽ", "z"),
    ("łŁ", "l"),
    ("ýÝ", "y"),
    ("řŘ", "r"),
    ("ğĞ", "g"),
    ("ťŤ", "t"),
];

/// Names of other languages: French, Spanish, Italian, Portuguese, Dutch, Polish, Czech, Swedish, Turkish, Russian,
/// Chinese, Japanese and Korean. What is normal or tangential comes before what is a force.
const ELSEWHERE: [(Meaning, &str); 10] = [
    (
        Meaning::Coefficient,
        "coefficiente coeficiente coefficientd wspolczynnik soucinitel coefficientde frictionskoef katsayi коэффициент \
         摩擦系数 摩擦係数 摩擦因数 마찰계수",
    ),
    (
        Meaning::Rate,
        "vitesse velocidad velocita velocidade snelheid predkosc rychlost hastighet скорость 速度 频率 周波数 속도",
    ),
    (Meaning::Other, "temperatura température температура 温度 온도"),
    (
        Meaning::Load,
        "forcenormale fuerzanormal forzanormale forcanormal normaalkracht silanormalna normalovasila normalkraft \
         normalkuvvet \
         carganormal caricon charge carga carico belasting obciazenie zatizeni нормальнаясила \
         нормальнаянагрузка нагрузка \
         法向力 法向载荷 正压力 载荷 垂直荷重 垂直力 法線力 荷重 수직력 수직하중 하중",
    ),
    (
        Meaning::Force(1),
        "forcetangentielle forcedefrottement fuerzatangencial fuerzadefriccion fuerzaderozamiento forzatangenziale \
         forzadattrito forzadiattrito forcatangencial forcadeatrito wrijvingskracht tangentielekracht silatarcia \
         silastyczna trecisila tecnasila friktionskraft surtunmekuvveti силатрения тангенциальнаясила 摩擦力 切向力 \
         剪切力 接線力 せん断力 마찰력 접선력",
    ),
    (Meaning::Force(3), "fuerza forza forca kracht sila kuvvet сила 力"),
    (Meaning::Time, "temps tiempo tempo tijd czas cas zaman время 时间 時間 时刻 時刻 시간"),
    (Meaning::Depth, "profondeur profundidad profondita diepte глубина износ 深度 磨损 摩耗 깊이"),
    (
        Meaning::Displacement(1),
        "deplacement desplazamiento spostamento deslocamento verplaatsing przemieszczenie posunuti posuv forskjutning \
         yerdegistirme перемещение смещение 位移 変位 변위",
    ),
    (
        Meaning::Displacement(2),
        "posicion posizione posicao positie pozycja poloha konum положение позиция координата 位置 위치",
    ),
];
/// Whole words of them, where a part of a word says nothing.
const SHORT: [&str; 7] = ["cas", "sila", "charge", "temps", "tempo", "czas", "carga"];

impl Words {
    fn of(name: &str) -> Words {
        let mut plain = String::new();
        let mut was_lower = false;
        for letter in name.chars() {
            if was_lower && letter.is_uppercase() {
                plain.push(' ');
            }
            was_lower = letter.is_lowercase();
            match letter {
                'ä' | 'Ä' => plain.push_str("ae"),
                'ö' | 'Ö' => plain.push_str("oe"),
                'ü' | 'Ü' => plain.push_str("ue"),
                'ß' => plain.push_str("ss"),
                '\u{b5}' | 'μ' => plain.push_str("mu"),
                _ if FOLDED.iter().any(|(marked, _)| marked.contains(letter)) => {
                    let folded = FOLDED.iter().find(|(marked, _)| marked.contains(letter));
                    plain.push_str(folded.map_or("", |(_, letter)| letter));
                }
                _ if letter.is_alphanumeric() => plain.extend(letter.to_lowercase()),
                _ => plain.push(' '),
            }
        }
        let words: Vec<String> = plain.split_whitespace().map(str::to_owned).collect();
        Words { joined: words.concat(), words }
    }

    /// Whether it has one of these words.
    fn has(&self, words: &str) -> bool {
        let bare = |own: &str| own.trim_end_matches(|letter: char| letter.is_ascii_digit()).to_owned();
        words.split(' ').any(|word| self.words.iter().any(|own| own == word || word.len() > 1 && bare(own) == word))
    }

    /// Whether one of these stands anywhere in it.
    fn contains(&self, parts: &str) -> bool {
        parts.split(' ').any(|part| self.joined.contains(part))
    }

    /// Whether it is one of these words, but for numbers.
    fn is(&self, words: &str) -> bool {
        let joined = self.joined.trim_end_matches(|letter: char| letter.is_ascii_digit());
        words.split(' ').any(|word| joined == word)
    }
}

/// What a column of a bench is called.
pub(super) fn meaning(name: &str) -> Meaning {
    let words = Words::of(name);
    let has = |list: &str| words.has(list);
    let contains = |list: &str| words.contains(list);
    let along = contains("displacement verschieb auslenkung position weg") || has("disp pos");
    let elsewhere = || {
        let is_in = |names: &&str| {
            let stands = |name: &str| if SHORT.contains(&name) { words.has(name) } else { words.joined.contains(name) };
            names.split_whitespace().any(stands)
        };
        ELSEWHERE.iter().find(|(_, names)| is_in(names)).map(|(meaning, _)| *meaning)
    };
    if is_index(&words) {
        Meaning::Index
    } else if contains("coefficient koeffizient coeff reibwert reibungszahl reibzahl beiwert verhaeltnis faktor")
        || has("cof mu cf srr ratio factor")
        || is_quotient(name)
    {
        Meaning::Coefficient
    } else if contains(
        "setpoint command target demand desired programm vorgabe fuehrungs stellgr nominal nennwert referen",
    ) || has("cmd set soll ref sp dmd ziel drive input")
        || words.joined.starts_with("soll")
    {
        Meaning::Command
    } else if contains("velocity speed geschwindigkeit accelerat beschleunig frequen drehzahl")
        || has("rate v vel freq hz")
    {
        Meaning::Rate
    } else if has("error err fehler std sd stdev sigma uncertainty max maximum min minimum peak amplitude pp range") {
        Meaning::Statistic
    } else if contains(
        "temperatur humidity feuchte voltage spannung current resistance widerstand potential power leistung energy \
         energie angle winkel torque drehmoment acoustic viscos comment kommentar remark bemerkung status \
         note filmthick",
    ) || has("temp strom flag label film")
    {
        Meaning::Other
    } else if contains("timestamp zeit datetime datenum uhrzeit fechayhora")
        || has("time t date datum elapsed clock fecha hora heure")
    {
        Meaning::Time
    } else if contains("depth penetration wear tiefe verschlei eindring indentation")
        || along && has("normal vertical z axial height")
        || words.is("z uz dz h")
    {
        Meaning::Depth
    } else if contains("tangentialload frictionload shearload lateralload") {
        Meaning::Force(1)
    } else if contains(
        "normalforce normalload normalkraft normallast appliedload anpress auflast prueflast pruefkraft druckkraft \
         belastung axialforce axialload axialkraft verticalforce contactload contactforce preload vorlast deadweight",
    ) || has("normal load last fz fn nf weight gewicht poids peso")
        || has("mass masse") && !contains("loss verlust")
        || words.joined.starts_with("forcez")
        || has("force kraft f") && has("z n normal vertical axial")
        || words.is("p")
    {
        Meaning::Load
    } else if contains(
        "frictionforce frictionalforce reibkraft reibungskraft tangential traction shearforce lateralforce",
    ) || contains("querkraft schubkraft scherkraft")
        || has("ft ff ffric fr fric q ftan")
    {
        Meaning::Force(1)
    } else if has("fx") || has("force kraft f") && has("x") {
        Meaning::Force(2)
    } else if has("fy") || has("force kraft f") && has("y") {
        Meaning::Force(4)
    } else if let Some(meaning @ (Meaning::Load | Meaning::Force(1))) = elsewhere() {
        meaning
    } else if contains("force kraft") || has("f loadcell") {
        Meaning::Force(3)
    } else if contains("friction reibung") {
        Meaning::Friction
    } else if contains("distance pathlength gleitweg reibweg weglaenge gesamtweg laufweg") {
        Meaning::Distance
    } else if has("y uy") {
        Meaning::Displacement(6)
    } else if contains("displacement verschieb linearposition schwingweg relativweg auslenkung")
        || has("disp slip schlupf")
    {
        Meaning::Displacement(1)
    } else if contains("position istweg") || has("pos weg") || words.joined.ends_with("weg") {
        Meaning::Displacement(2)
    } else if words.is("u x d s ux ud delta dx xs") {
        Meaning::Displacement(3)
    } else if contains("stroke deflection lvdt encoder extension travel wegsensor wegaufnehmer") || has("hub") {
        Meaning::Displacement(4)
    } else {
        elsewhere().unwrap_or(Meaning::Unknown)
    }
}

fn is_index(words: &Words) -> bool {
    let has = |list: &str| words.has(list);
    words.joined.is_empty()
        || has("index idx unnamed nr no number nummer zeile row counter messpunkt pkt id lap laps record")
        || has(
            "cycle cycles zyklus zyklen lastwechsel turn turns revolution revolutions umdrehung umdrehungen zykluszahl",
        )
        || words.is("i n point sample samples punkt count frame datapoint pixel zykluszahl")
}

/// Whether a name is a ratio of two forces by their letters, as in `Q/P`.
fn is_quotient(name: &str) -> bool {
    let plain: String = name.chars().filter(|letter| letter.is_alphanumeric() || *letter == '/').collect();
    let letters = |word: &str, list: &[&str]| list.contains(&word.to_lowercase().as_str());
    plain.split_once('/').is_some_and(|(over, under)| {
        letters(over, &["q", "t", "f", "ft", "ff", "fx"]) && letters(under, &["p", "fn", "fz", "w"])
    })
}

/// What a column of a scan holds, by its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Axis {
    X,
    Y,
    /// A height. The rank orders names that fit less and less.
    Z,
    /// Neither, with the reason.
    Left(&'static str),
    Unknown,
}

/// What a column of a scan is called.
pub(super) fn axis(name: &str) -> Axis {
    let words = Words::of(name);
    let meaning = meaning(name);
    if is_index(&words) {
        return Axis::Left(Meaning::Index.reason());
    }
    let is_height = words.contains(
        "height hoehe profil topogra elevation depth tiefe filtered gefiltert rauheit roughness waviness welligkeit \
         surface hauteur altura altezza hoogte wysokosc vyska высота 高度 高さ 높이",
    ) || words.has("z raw roh deviation abweichung deflection");
    if words.has("y") {
        Axis::Y
    } else if words.has("error err fehler std sd stdev sigma uncertainty intensity quality valid mask") {
        Axis::Left("not a height")
    } else if is_height && !words.contains("profilelength profilposition") {
        Axis::Z
    } else if words.has("x lateral ort abstand abscissa laenge length")
        || words.contains("lateral scanlength taststrecke messstrecke")
    {
        Axis::X
    } else {
        match meaning {
            Meaning::Displacement(_) | Meaning::Distance => Axis::X,
            Meaning::Depth => Axis::Z,
            Meaning::Unknown | Meaning::Load => Axis::Unknown,
            other => Axis::Left(other.reason()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Axis, Meaning, axis, meaning};

    #[test]
    fn names_of_tribometers_mean_what_they_say() {
        let is = |expected: fn(Meaning) -> bool, names: &[&str]| {
            for name in names {
                assert!(expected(meaning(name)), "{name}: {:?}", meaning(name));
            }
        };
        is(
            |meaning| matches!(meaning, Meaning::Displacement(_)),
            &[
                "Displacement",
                "Linear Position",
                "LinearPosition",
                "Position",
                "Relative displacement",
                "Weg",
                "Istweg",
                "Schwingweg",
                "Verschiebung",
                "Hub",
                "Stroke",
                "u",
                "x",
                "d",
                "Slip",
                "Relativweg",
                "X Position",
                "HS Displacement",
                "Disp.",
                "LVDT",
                "Wegsensor",
            ],
        );
        is(
            |meaning| matches!(meaning, Meaning::Force(_)),
            &[
                "Force",
                "Friction force",
                "Friction Force",
                "Reibkraft",
                "Reibungskraft",
                "Tangential force",
                "Tangentialkraft",
                "Traction Force",
                "Fx",
                "Ft",
                "Ff",
                "Q",
                "F",
                "Querkraft",
                "Lateral force",
                "FrictionForce",
                "Kraft",
                "Shear force",
                "Force X",
            ],
        );
        is(
            |meaning| meaning == Meaning::Load,
            &[
                "Normal force",
                "Normal Force",
                "Load",
                "Fn",
                "Fz",
                "F_N",
                "P",
                "Normalkraft",
                "Auflast",
                "Ball load",
                "Applied load",
                "Force Z",
                "Last",
            ],
        );
        is(
            |meaning| meaning == Meaning::Coefficient,
            &[
                "Friction coefficient",
                "Coefficient of Friction",
                "COF",
                "µ",
                "mu",
                "Reibwert",
                "Reibungszahl",
                "Reibungskoeffizient",
                "Q/P",
                "Ft/Fn",
                "Traction coeff.",
                "Friction Coefficient",
                "Reibbeiwert",
                "Kraftverhältnis",
            ],
        );
        is(
            |meaning| meaning == Meaning::Command,
            &[
                "Displacement command",
                "Force setpoint",
                "Set point",
                "Sollweg",
                "Soll-Kraft",
                "Position target",
                "Nominal load",
                "Cmd position",
                "Führungsgröße",
                "Displacement reference",
            ],
        );
        is(
            |meaning| meaning == Meaning::Rate,
            &["Velocity", "Sliding speed", "Geschwindigkeit", "Frequency", "Displacement rate", "Max linear speed"],
        );
        is(
            |meaning| meaning == Meaning::Depth,
            &["Penetration Depth", "Wear", "Verschleiß", "Eindringtiefe", "z", "Normal displacement", "Position Z"],
        );
        is(
            |meaning| meaning == Meaning::Index,
            &["", "#", "Index", "Sample", "Nr.", "No.", "Cycle", "Zyklus", "lap", "Unnamed: 0", "Point number"],
        );
        is(
            |meaning| meaning == Meaning::Time,
            &["Time", "t", "Zeit", "Date and time", "Elapsed", "Timestamp", "Uhrzeit", "Test time", "Step time"],
        );
        is(|meaning| meaning == Meaning::Friction, &["Friction", "Reibung"]);
        is(|meaning| meaning == Meaning::Distance, &["Distance", "Sliding distance", "Gleitweg"]);
        is(
            |meaning| meaning == Meaning::Other,
            &["Contact Potential", "Temperature", "Upper specimen temp", "Umgebungstemperatur"],
        );
    }

    #[test]
    fn axes_of_scans_are_known_by_name() {
        for (names, expected) in [
            (&["x", "X", "Position", "Lateral", "Distance", "Scan length", "Weg", "Taststrecke"][..], Axis::X),
            (&["z", "Height", "Höhe", "Total Profile", "raw", "filtered", "Depth", "Profil", "Topography"], Axis::Z),
            (&["y", "Y", "Position Y"], Axis::Y),
            (&["signal", "a"], Axis::Unknown),
        ] {
            for name in names {
                assert_eq!(axis(name), expected, "{name}");
            }
        }
        for name in ["", "#", "Index", "Time", "Velocity", "Temperature"] {
            assert!(matches!(axis(name), Axis::Left(_)), "{name}");
        }
    }
}

//! Closed expressions of a few variables, and their exact derivatives along a line.

/// A value and its first two derivatives by a parameter.
pub(crate) type Jet = [f64; 3];

/// An expression of `+ - * / ^`, parentheses, numbers, `pi`, functions of one argument and variables.
///
/// `^` is a power, which may be written `**` too; it binds more closely than a sign before it, `-x^2 = -(x^2)`, and
/// `a^b^c = a^(b^c)`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Expression {
    /// Operations on a stack of values, in the order in which they are done.
    operations: Vec<Operation>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Operation {
    Number(f64),
    Variable(usize),
    Negate,
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
    Apply(usize),
}

/// The reasons for which a text is no expression. Places are characters, counted from 1.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs)] // each variant is documented by its message
pub enum ExpressionError {
    #[error("`{name}` at character {at} is not known; there are {known}")]
    Unknown { name: String, at: usize, known: String },
    #[error("`{found}` at character {at} of `{text}`: expected {expected}")]
    Unexpected { text: String, found: char, at: usize, expected: &'static str },
    #[error("`{text}` ends where {expected} is expected")]
    End { text: String, expected: &'static str },
    #[error("an expression has at most {LONGEST} characters")]
    TooLong,
}

/// Largest number of characters.
const LONGEST: usize = 500;

/// A name, and the function with its first two derivatives.
type NamedFunction = (&'static str, fn(f64) -> Jet);

/// Functions by name.
const FUNCTIONS: [NamedFunction; 13] = [
    ("abs", |x| [x.abs(), sign(x), 0.0]),
    ("sign", |x| [sign(x), 0.0, 0.0]),
    ("sqrt", |x| [x.sqrt(), 0.5 / x.sqrt(), -0.25 / (x * x.sqrt())]),
    ("exp", |x| [x.exp(); 3]),
    ("ln", |x| [x.ln(), 1.0 / x, -1.0 / (x * x)]),
    ("sin", |x| [x.sin(), x.cos(), -x.sin()]),
    ("cos", |x| [x.cos(), -x.sin(), -x.cos()]),
    ("tan", |x| [x.tan(), x.cos().powi(-2), 2.0 * x.tan() * x.cos().powi(-2)]),
    ("asin", |x| [x.asin(), (1.0 - x * x).powf(-0.5), x * (1.0 - x * x).powf(-1.5)]),
    ("atan", |x| [x.atan(), 1.0 / (1.0 + x * x), -2.0 * x / (1.0 + x * x).powi(2)]),
    ("sinh", |x| [x.sinh(), x.cosh(), x.sinh()]),
    ("cosh", |x| [x.cosh(), x.sinh(), x.cosh()]),
    ("tanh", |x| [x.tanh(), x.cosh().powi(-2), -2.0 * x.tanh() * x.cosh().powi(-2)]),
];

/// Functions whose values or slopes jump where their argument changes its sign.
const JUMPING: [&str; 2] = ["abs", "sign"];

fn sign(x: f64) -> f64 {
    if x == 0.0 { 0.0 } else { x.signum() }
}

impl Expression {
    /// Reads an expression of these variables.
    pub(crate) fn parse(text: &str, variables: &[&str]) -> Result<Self, ExpressionError> {
        if text.chars().count() > LONGEST {
            return Err(ExpressionError::TooLong);
        }
        let mut parser = Parser { text: text.chars().collect(), at: 0, variables, operations: Vec::new() };
        parser.sum()?;
        match parser.next() {
            None => Ok(Self { operations: parser.operations }),
            Some(_) => Err(parser.unexpected("an operator, or the end")),
        }
    }

    /// Whether its values or slopes may jump.
    pub(crate) fn may_jump(&self) -> bool {
        let jumps = |function: usize| JUMPING.contains(&FUNCTIONS[function].0);
        self.operations.iter().any(|step| matches!(*step, Operation::Apply(function) if jumps(function)))
    }

    /// Returns the value where the variables are these, and its derivatives while they move.
    pub(crate) fn at(&self, variables: &[Jet]) -> Jet {
        let mut stack: Vec<Jet> = Vec::with_capacity(8);
        for step in &self.operations {
            let value = match *step {
                Operation::Number(number) => [number, 0.0, 0.0],
                Operation::Variable(which) => variables[which],
                Operation::Negate => pop(&mut stack).map(|part| -part),
                Operation::Apply(function) => {
                    let inner = pop(&mut stack);
                    chain(FUNCTIONS[function].1(inner[0]), inner)
                }
                binary => {
                    let (right, left) = (pop(&mut stack), pop(&mut stack));
                    of_two(binary, left, right)
                }
            };
            stack.push(value);
        }
        pop(&mut stack)
    }
}

/// The parser pushes as many values as it takes.
fn pop(stack: &mut Vec<Jet>) -> Jet {
    stack.pop().unwrap_or([f64::NAN; 3])
}

/// A function of a value that moves, from its own derivatives.
fn chain([f, first, second]: Jet, [_, speed, change]: Jet) -> Jet {
    if speed == 0.0 && change == 0.0 {
        return [f, 0.0, 0.0]; // also where the function has no derivative
    }
    [f, first * speed, first * change + second * speed * speed]
}

fn of_two(step: Operation, a: Jet, b: Jet) -> Jet {
    let product =
        |a: Jet, b: Jet| [a[0] * b[0], a[1] * b[0] + a[0] * b[1], a[2] * b[0] + 2.0 * a[1] * b[1] + a[0] * b[2]];
    match step {
        Operation::Add => [0, 1, 2].map(|k| a[k] + b[k]),
        Operation::Subtract => [0, 1, 2].map(|k| a[k] - b[k]),
        Operation::Multiply => product(a, b),
        Operation::Divide => {
            let value = a[0] / b[0];
            let speed = (a[1] - value * b[1]) / b[0];
            [value, speed, (a[2] - 2.0 * speed * b[1] - value * b[2]) / b[0]]
        }
        _ if b[1] == 0.0 && b[2] == 0.0 => chain(power(a[0], b[0]), a),
        _ => {
            let logarithm = chain([a[0].ln(), 1.0 / a[0], -1.0 / (a[0] * a[0])], a);
            let exponent = product(b, logarithm);
            chain([exponent[0].exp(); 3], exponent)
        }
    }
}

/// A power with a constant exponent; a derivative whose factor is 0 is 0, also at 0.
fn power(x: f64, exponent: f64) -> Jet {
    // small whole exponents are products, which need no logarithm
    let of = |exponent: f64| match exponent as i32 {
        whole @ -8..=8 if f64::from(whole) == exponent => x.powi(whole),
        _ => x.powf(exponent),
    };
    let term = |factor: f64, exponent: f64| if factor == 0.0 { 0.0 } else { factor * of(exponent) };
    [of(exponent), term(exponent, exponent - 1.0), term(exponent * (exponent - 1.0), exponent - 2.0)]
}

/// Reads an expression from left to right, and writes its operations in the order in which they are done.
struct Parser<'a> {
    text: Vec<char>,
    /// Number of the next character.
    at: usize,
    variables: &'a [&'a str],
    operations: Vec<Operation>,
}

impl Parser<'_> {
    /// The next character that is not a space.
    fn next(&mut self) -> Option<char> {
        while self.text.get(self.at).is_some_and(|c| c.is_whitespace()) {
            self.at += 1;
        }
        self.text.get(self.at).copied()
    }

    fn take(&mut self, wanted: char) -> bool {
        let found = self.next() == Some(wanted);
        self.at += usize::from(found);
        found
    }

    fn unexpected(&mut self, expected: &'static str) -> ExpressionError {
        let found = self.next();
        let text = self.text.iter().collect();
        match found {
            Some(found) => ExpressionError::Unexpected { text, found, at: self.at + 1, expected },
            None => ExpressionError::End { text, expected },
        }
    }

    fn sum(&mut self) -> Result<(), ExpressionError> {
        self.joined(&[('+', Operation::Add), ('-', Operation::Subtract)], Self::product)
    }

    fn product(&mut self) -> Result<(), ExpressionError> {
        self.joined(&[('*', Operation::Multiply), ('/', Operation::Divide)], Self::signed)
    }

    /// Reads operands that are joined by these operators, from left to right.
    fn joined(
        &mut self,
        operators: &[(char, Operation)],
        operand: fn(&mut Self) -> Result<(), ExpressionError>,
    ) -> Result<(), ExpressionError> {
        operand(self)?;
        while let Some((sign, operation)) = operators.iter().find(|(sign, _)| self.next() == Some(*sign)) {
            self.take(*sign);
            operand(self)?;
            self.operations.push(*operation);
        }
        Ok(())
    }

    fn signed(&mut self) -> Result<(), ExpressionError> {
        if self.take('-') {
            self.signed()?;
            self.operations.push(Operation::Negate);
            return Ok(());
        }
        self.take('+');
        self.factor()
    }

    fn factor(&mut self) -> Result<(), ExpressionError> {
        self.atom()?;
        let doubled = self.next() == Some('*') && self.text.get(self.at + 1) == Some(&'*');
        if doubled || self.next() == Some('^') {
            self.at += if doubled { 2 } else { 1 };
            self.signed()?;
            self.operations.push(Operation::Power);
        }
        Ok(())
    }

    fn atom(&mut self) -> Result<(), ExpressionError> {
        match self.next() {
            Some('(') => self.parenthesis(),
            Some(c) if c.is_ascii_digit() || c == '.' => self.number(),
            Some(c) if c.is_alphabetic() => self.name(),
            _ => Err(self.unexpected("a number, a name or `(`")),
        }
    }

    fn parenthesis(&mut self) -> Result<(), ExpressionError> {
        if !self.take('(') {
            return Err(self.unexpected("`(`"));
        }
        self.sum()?;
        if self.take(')') { Ok(()) } else { Err(self.unexpected("an operator or `)`")) }
    }

    /// Takes the characters from here to the first that is not wanted after the one before it.
    fn word(&mut self, wanted: impl Fn(char, char) -> bool) -> String {
        let mut word = String::new();
        while let Some(&c) = self.text.get(self.at).filter(|c| wanted(**c, word.chars().last().unwrap_or_default())) {
            word.push(c);
            self.at += 1;
        }
        word
    }

    fn number(&mut self) -> Result<(), ExpressionError> {
        let start = self.at;
        let word = self
            .word(|c, before| c.is_ascii_digit() || ".eE".contains(c) || ("+-".contains(c) && "eE".contains(before)));
        let Ok(number) = word.parse() else {
            self.at = start;
            return Err(self.unexpected("a number"));
        };
        self.operations.push(Operation::Number(number));
        Ok(())
    }

    fn name(&mut self) -> Result<(), ExpressionError> {
        let at = self.at + 1;
        let name = self.word(|c, _| c.is_alphanumeric() || c == '_');
        if let Some(which) = self.variables.iter().position(|variable| *variable == name) {
            self.operations.push(Operation::Variable(which));
        } else if name == "pi" {
            self.operations.push(Operation::Number(std::f64::consts::PI));
        } else if let Some(function) = FUNCTIONS.iter().position(|(known, _)| *known == name) {
            self.parenthesis()?;
            self.operations.push(Operation::Apply(function));
        } else {
            let functions = FUNCTIONS.iter().map(|(known, _)| *known);
            let known: Vec<&str> = self.variables.iter().copied().chain(["pi"]).chain(functions).collect();
            return Err(ExpressionError::Unknown { name, at, known: known.join(", ") });
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(text: &str, [x, y]: [f64; 2]) -> f64 {
        Expression::parse(text, &["x", "y"]).unwrap().at(&[[x, 0.0, 0.0], [y, 0.0, 0.0]])[0]
    }

    /// Claim: operators bind as in mathematics and in Python. Source: the values, by hand or by Python.
    #[test]
    fn operators_bind_as_usual() {
        let cases = [
            ("-x^2", -4.0),
            ("-x**2 + 1", -3.0),
            ("2^3^2", 512.0),
            ("2^-1", 0.5),
            ("8/2/2 - 1 - 1", 0.0),
            ("2*-x", -4.0),
            ("(x + y)*(x - y)", -5.0),
            (" 1.5e1 + .5 +2.E0", 17.5),
            ("sin(pi/2) + ln(exp(x)) - sqrt(abs(-y*y))", 0.0),
            ("sign(-3)*x^0", -1.0),
        ];
        for (text, expected) in cases {
            let found = value(text, [2.0, 3.0]);
            assert!((found - expected).abs() < 1e-14, "{text}: {found}, expected {expected}");
        }
    }

    /// Claim: derivatives along a line are those of the value, for every function and operator, at both signs where the
    /// function is defined there. Source: extrapolated differences. Tolerance: their rounding errors.
    #[test]
    fn derivatives_are_right() {
        let operators = ["x*y + x/y - 3", "x^3 - y^2", "abs(x)^(4/3)", "(1 + x*x)^y", "2^x", "-(x - y)^2/(1 + y^4)"];
        let functions = FUNCTIONS.map(|(name, _)| format!("{name}(0.3*x + 0.2*y^2)"));
        for text in operators.into_iter().map(String::from).chain(functions) {
            let expression = Expression::parse(&text, &["x", "y"]).unwrap();
            for x in [-0.3, 0.9] {
                let along = |t: f64| expression.at(&[[x + t, 1.0, 0.0], [1.3 - 0.5 * t, -0.5, 0.0]]);
                let slope = |k: usize, h: f64| (along(h)[k] - along(-h)[k]) / (2.0 * h);
                let extrapolated = |k: usize| (4.0 * slope(k, 5e-4) - slope(k, 1e-3)) / 3.0;
                for k in [0, 1] {
                    let (found, expected) = (along(0.0)[k + 1], extrapolated(k));
                    assert!((found - expected).abs() < 1e-8 * (1.0 + expected.abs()), "{text}: {found} {expected}");
                }
            }
        }
    }

    /// Claim: what is no expression is refused with its place.
    #[test]
    fn faults_name_their_place() {
        let cases = [
            ("x +", "ends where a number, a name or `(` is expected"),
            ("3x", "`x` at character 2 of `3x`: expected an operator"),
            ("sin x", "`x` at character 5 of `sin x`: expected `(`"),
            ("(x", "ends where an operator or `)` is expected"),
            ("x # y", "`#` at character 3"),
            ("2e*x", "`2` at character 1 of `2e*x`: expected a number"),
            ("Sinh(x)", "`Sinh` at character 1 is not known; there are x, y, pi, abs"),
            ("", "ends where"),
        ];
        for (text, message) in cases {
            let found = Expression::parse(text, &["x", "y"]).unwrap_err().to_string();
            assert!(found.contains(message), "{text}: {found}");
        }
        assert_eq!(Expression::parse(&"(".repeat(501), &[]).unwrap_err(), ExpressionError::TooLong);
        assert!(Expression::parse(&"(".repeat(500), &[]).is_err());
    }
}

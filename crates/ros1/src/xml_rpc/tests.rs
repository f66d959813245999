use proptest::prelude::*;

use super::reader::MethodCall;
use super::*;

fn any_value() -> impl Strategy<Value = ParameterValue> {
    let leaf = prop_oneof![
        any::<bool>().prop_map(ParameterValue::Bool),
        any::<i32>().prop_map(ParameterValue::Int),
        any::<f64>().prop_filter("NaN is unequal", |x| !x.is_nan()).prop_map(ParameterValue::Double),
        "[ -~\t\r\n\u{e9}\u{4e2d}\u{1f916}]{0,20}".prop_map(ParameterValue::String),
        any::<Vec<u8>>().prop_map(ParameterValue::Base64),
        Just(ParameterValue::DateTime("19980717T14:08:55".to_owned())),
    ];
    leaf.prop_recursive(4, 40, 6, |inner| {
        prop_oneof![
            prop::collection::vec(inner.clone(), 0..6).prop_map(ParameterValue::List),
            prop::collection::btree_map("[ -~]{0,8}", inner, 0..6).prop_map(ParameterValue::Struct),
        ]
    })
}

proptest! {
    #[test]
    fn values_come_back(value in any_value()) {
        let xml = xml_from_response(&value).unwrap();
        prop_assert_eq!(response_from_xml(xml.as_bytes()).unwrap().unwrap(), value.clone());
        let xml = xml_from_call("a.b", std::slice::from_ref(&value)).unwrap();
        let call = call_from_xml(xml.as_bytes()).unwrap();
        prop_assert_eq!(call, MethodCall { method: "a.b".to_owned(), params: vec![value] });
    }

    #[test]
    fn any_bytes_are_refused_or_read(bytes: Vec<u8>) {
        let _ = (call_from_xml(&bytes), response_from_xml(&bytes));
    }
}

fn value(xml: &str) -> Option<ParameterValue> {
    let body = format!("<methodResponse><params><param>{xml}</param></params></methodResponse>");
    response_from_xml(body.as_bytes()).ok()?.ok()
}

#[test]
fn values_in_the_forms_of_other_writers() {
    let string = |text: &str| Some(ParameterValue::String(text.to_owned()));
    assert_eq!(value("<value>bare &lt; text</value>"), string("bare < text"));
    assert_eq!(value("<value/>"), string(""));
    assert_eq!(value("<value><string/></value>"), string(""));
    assert_eq!(value("<value>\n <i4> -7 </i4>\n</value>"), Some(ParameterValue::Int(-7)));
    assert_eq!(value("<value><i8>3</i8></value>"), Some(ParameterValue::Int(3)));
    assert_eq!(value("<value><double>1e-3</double></value>"), Some(ParameterValue::Double(1e-3)));
    assert_eq!(value("<value><double>inf</double></value>"), Some(ParameterValue::Double(f64::INFINITY)));
    assert_eq!(value("<value><string><![CDATA[<a>]]></string></value>"), string("<a>"));
    for bad in [
        "<value><int>2147483648</int></value>",
        "<value><boolean>2</boolean></value>",
        "<value><nil/></value>",
        "<value><array/></value>",
        "<value><base64>?</base64></value>",
        "<value><struct><member><name>a</name></member></struct></value>",
    ] {
        assert_eq!(value(bad), None, "{bad}");
    }
}

#[test]
fn faults_are_returned() {
    let fault = response_from_xml(xml_from_fault(3, "no <such>\u{1} method").as_bytes()).unwrap();
    assert_eq!(fault, Err(Fault { code: 3, text: "no <such> method".to_owned() }));
}

#[test]
fn deep_or_exploding_xml_is_refused() {
    let nested = |depth| {
        let (open, close) = ("<value><array><data>".repeat(depth), "</data></array></value>".repeat(depth));
        value(&format!("{open}{close}"))
    };
    assert!(nested(MOST_NESTED).is_some());
    assert!(nested(MOST_NESTED + 2).is_none());
    assert!(nested(100_000).is_none());
    let laughs = "<!DOCTYPE x [<!ENTITY a \"ha\">]><methodCall><methodName>&a;</methodName></methodCall>";
    assert!(call_from_xml(laughs.as_bytes()).is_err());
    let control = ParameterValue::String("\u{1}".to_owned());
    assert!(xml_from_response(&control).unwrap_err().to_string().contains("Base64"));
}

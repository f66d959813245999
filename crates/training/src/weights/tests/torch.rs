use std::process::Command;

use super::*;

/// Layers named as in torchvision's MobileNet, saved in each of PyTorch's formats; the values count up from 0.
const WRITE: &str = r#"
import sys, torch
from torch import nn

def block(inputs, outputs, **options):
    return nn.Sequential(nn.Conv2d(inputs, outputs, bias=False, **options), nn.BatchNorm2d(outputs), nn.ReLU6())

class Net(nn.Module):
    def __init__(self):
        super().__init__()
        self.features = nn.Sequential(block(3, 8, kernel_size=3), block(8, 8, kernel_size=3, groups=8))
        self.classifier = nn.Sequential(nn.Dropout(), nn.Linear(8, 5))

net, count = Net(), 0
for weight in net.state_dict().values():
    if weight.is_floating_point():
        weight.copy_(torch.arange(count, count + weight.numel()).reshape(weight.shape))
        count += weight.numel()
folder = sys.argv[1] + "/"
torch.save(net.state_dict(), folder + "zip.pth")
torch.save(net.state_dict(), folder + "legacy.pth", _use_new_zipfile_serialization=False)
torch.save(net.half().state_dict(), folder + "half.pth")
torch.save({"epoch": 3, "state_dict": net.float().state_dict(), "lr": [0.1]}, folder + "nested.pth")
"#;

/// Needs a Python with torch in `OPENDR_TORCH_PYTHON`.
#[test]
fn checkpoints_of_pytorch_itself_are_read() {
    let Some(python) = std::env::var_os("OPENDR_TORCH_PYTHON") else {
        println!("skipped: no OPENDR_TORCH_PYTHON");
        return;
    };
    let folder = std::env::temp_dir().join(format!("opendr-torch-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let run = Command::new(python).arg("-c").arg(WRITE).arg(&folder).output().unwrap();
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    for (file, prefix) in [("zip", ""), ("legacy", ""), ("half", ""), ("nested", "state_dict.")] {
        let table = WeightTable::from_file(&folder.join(file).with_extension("pth")).unwrap();
        assert_eq!(table.weights().len(), 12, "{file}");
        let mut next = 0;
        for (name, shape) in [
            ("features.0.0.weight", &[8, 3, 3, 3][..]),
            ("features.0.1.weight", &[8]),
            ("features.0.1.bias", &[8]),
            ("features.0.1.running_mean", &[8]),
            ("features.0.1.running_var", &[8]),
            ("features.1.0.weight", &[8, 1, 3, 3]),
            ("features.1.1.weight", &[8]),
            ("features.1.1.bias", &[8]),
            ("features.1.1.running_mean", &[8]),
            ("features.1.1.running_var", &[8]),
            ("classifier.1.weight", &[5, 8]),
            ("classifier.1.bias", &[5]),
        ] {
            let weight = table.get(&format!("{prefix}{name}")).unwrap();
            assert_eq!(weight.shape(), shape, "{file} {name}");
            for number in weight.values() {
                assert_eq!(*number, next as f32, "{file} {name}");
                next += 1;
            }
        }
    }
    std::fs::remove_dir_all(&folder).unwrap();
}

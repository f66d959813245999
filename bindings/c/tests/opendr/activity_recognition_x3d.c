/* A program written for OpenDR 3.0's C API: activity_recognition_x3d MODEL */
#undef NDEBUG
#include <assert.h>

#include "activity_recognition_x3d.h"
#include "opendr_utils.h"
#include "print_tensors.h"

int main(int argc, char **argv) {
    char mode[] = "l", unknown[] = "xxl";
    X3dModelT model, missing;
    OpenDRTensorT tensor;
    OpenDRTensorVectorT outputs;
    assert(argc == 2);
    loadX3dModel(argv[1], mode, &model);
    assert(model.onnxSession != NULL && model.env != NULL && model.sessionOptions != NULL);
    initTensor(&tensor);
    initTensorVector(&outputs);
    initRandomOpenDRTensorX3d(&tensor, &model);
    assert(tensor.frames == model.framesPerClip && tensor.width == model.modelSize);
    forwardX3d(&model, &tensor, &outputs);
    assert(outputs.nTensors == 1 && outputs.heights[0] == model.features);

    /* Both are used again. */
    initRandomOpendrTensorX3d(&tensor, &model);
    fill(&tensor);
    forwardX3d(&model, &tensor, &outputs);
    print_tensors(&outputs);
    tensor.channels += 1;
    tensor.width = 1;
    forwardX3d(&model, &tensor, &outputs);
    assert(outputs.nTensors == 0 && strstr(opendr_last_error(), "model input") != NULL);

    loadX3dModel("no/such/model.onnx", mode, &missing);
    assert(missing.onnxSession == NULL && missing.env == NULL && missing.sessionOptions == NULL);
    forwardX3d(&missing, &tensor, &outputs);
    assert(outputs.nTensors == 0 && strstr(opendr_last_error(), "null") != NULL);
    freeX3dModel(&missing);
    loadX3dModel(argv[1], unknown, &missing);
    assert(missing.onnxSession == NULL && strstr(opendr_last_error(), "xs, s, m, l") != NULL);

    freeTensor(&tensor);
    freeTensorVector(&outputs);
    freeX3dModel(&model);
    assert(model.onnxSession == NULL);
    freeX3dModel(&model);
    freeTensor(&tensor);
    freeTensorVector(&outputs);
    return 0;
}

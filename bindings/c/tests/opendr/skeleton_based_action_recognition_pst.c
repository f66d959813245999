/* A program written for OpenDR 3.0's C API: skeleton_based_action_recognition_pst MODEL */
#undef NDEBUG
#include <assert.h>

#include "opendr_utils.h"
#include "print_tensors.h"
#include "skeleton_based_action_recognition_pst.h"

int main(int argc, char **argv) {
    PstModelT model, missing;
    OpenDRTensorT tensor;
    OpenDRTensorVectorT outputs;
    assert(argc == 2);
    loadPstModel(argv[1], &model);
    assert(model.onnxSession != NULL && model.env != NULL && model.sessionOptions != NULL);
    initTensor(&tensor);
    initTensorVector(&outputs);
    initRandomOpenDRTensorPst(&tensor, &model);
    assert(tensor.frames == model.inChannels && tensor.channels == model.features && tensor.height == model.nPerson);
    fill(&tensor);
    forwardPst(&model, &tensor, &outputs);
    assert(outputs.nTensors == 1 && outputs.widths[0] == model.batchSize && outputs.heights[0] == model.nClasses);
    print_tensors(&outputs);
    initRandomOpendrTensorPst(&tensor, &model);
    forwardPst(&model, &tensor, &outputs);
    assert(outputs.nTensors == 1);

    loadPstModel("no/such/model.onnx", &missing);
    assert(missing.onnxSession == NULL);
    freePstModel(&missing);

    freeTensor(&tensor);
    freeTensorVector(&outputs);
    freePstModel(&model);
    freePstModel(&model);
    return 0;
}

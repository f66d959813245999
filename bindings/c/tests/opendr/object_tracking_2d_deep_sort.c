/* A program written for OpenDR 3.0's C API: object_tracking_2d_deep_sort MODEL */
#undef NDEBUG
#include <assert.h>

#include "object_tracking_2d_deep_sort.h"
#include "opendr_utils.h"
#include "print_tensors.h"

int main(int argc, char **argv) {
    DeepSortModelT model, missing;
    OpenDRTensorT tensor;
    OpenDRTensorVectorT outputs;
    assert(argc == 2);
    loadDeepSortModel(argv[1], &model);
    assert(model.onnxSession != NULL && model.env != NULL && model.sessionOptions != NULL);
    assert(model.modelSize[0] == 128 && model.modelSize[1] == 256 && model.features == 512);
    initTensor(&tensor);
    initTensorVector(&outputs);
    initRandomOpenDRTensorDs(&tensor, &model);
    assert(tensor.width == model.modelSize[1] && tensor.height == model.modelSize[0]);
    fill(&tensor);
    forwardDeepSort(&model, &tensor, &outputs);
    assert(outputs.nTensors == 1 && outputs.heights[0] == model.features);
    print_tensors(&outputs);
    initRandomOpendrTensorDs(&tensor, &model);
    forwardDeepSort(&model, &tensor, &outputs);
    assert(outputs.nTensors == 1);

    loadDeepSortModel("no/such/model", &missing);
    assert(missing.onnxSession == NULL);
    freeDeepSortModel(&missing);

    freeTensor(&tensor);
    freeTensorVector(&outputs);
    freeDeepSortModel(&model);
    freeDeepSortModel(&model);
    return 0;
}

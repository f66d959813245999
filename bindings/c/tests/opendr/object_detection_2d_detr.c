/* A program written for OpenDR 3.0's C API: object_detection_2d_detr MODEL */
#undef NDEBUG
#include <assert.h>

#include "object_detection_2d_detr.h"
#include "opendr_utils.h"
#include "print_tensors.h"

int main(int argc, char **argv) {
    DetrModelT model, missing;
    OpenDRTensorT tensor;
    OpenDRTensorVectorT outputs;
    assert(argc == 2);
    loadDetrModel(argv[1], &model);
    assert(model.onnxSession != NULL && model.env != NULL && model.sessionOptions != NULL);
    assert(model.outputSizes[1] == 4);
    initTensor(&tensor);
    initTensorVector(&outputs);
    initRandomOpenDRTensorDetr(&tensor, &model);
    fill(&tensor);
    forwardDetr(&model, &tensor, &outputs);
    assert(outputs.nTensors == 2 && outputs.widths[0] == model.features);
    assert(outputs.heights[0] == model.outputSizes[0] && outputs.heights[1] == model.outputSizes[1]);
    printf("%g\n", (double)model.threshold);
    print_tensors(&outputs);
    initRandomOpendrTensorDetr(&tensor, &model);
    forwardDetr(&model, &tensor, &outputs);
    assert(outputs.nTensors == 2);

    /* There is no pretrained model. */
    loadDetrModel("", &missing);
    assert(missing.onnxSession == NULL && strstr(opendr_last_error(), "no pretrained model") != NULL);
    freeDetrModel(&missing);

    freeTensor(&tensor);
    freeTensorVector(&outputs);
    freeDetrModel(&model);
    freeDetrModel(&model);
    return 0;
}

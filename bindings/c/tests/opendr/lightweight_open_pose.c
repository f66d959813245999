/* A program written for OpenDR 3.0's C API: lightweight_open_pose MODEL IMAGE */
#undef NDEBUG
#include <assert.h>
#include <math.h>

#include "lightweight_open_pose.h"
#include "opendr_utils.h"
#include "print_tensors.h"

int main(int argc, char **argv) {
    OpenPoseModelT model, missing;
    OpenDRImageT image, none;
    OpenDRTensorT tensor;
    OpenDRTensorVectorT outputs;
    float lowest = 1.0f, highest = -1.0f;
    assert(argc == 3);
    loadOpenPoseModel(argv[1], &model);
    assert(model.onnxSession != NULL && model.env != NULL && model.sessionOptions != NULL);
    assert(model.modelSize == 256 && model.evenChannelOutput == 19 && model.oddChannelOutput == 38);
    loadImage(argv[2], &image);
    assert(image.data != NULL);
    initTensor(&tensor);
    initTensorVector(&outputs);
    initRandomOpenDRTensorOp(&tensor, &model);
    fill(&tensor);
    forwardOpenPose(&model, &tensor, &outputs);
    assert(outputs.nTensors == model.outputSize);
    print_tensors(&outputs);

    initOpenDRTensorFromImgOp(&image, &tensor, &model);
    assert(tensor.batchSize == 1 && tensor.channels == 3 && tensor.width == 256 && tensor.height == 256);
    assert(fabsf(tensor.data[0]) < 1e-6f); /* a wide image is padded at the top */
    for (int i = 0; i < 3 * 256 * 256; i++) {
        lowest = tensor.data[i] < lowest ? tensor.data[i] : lowest;
        highest = tensor.data[i] > highest ? tensor.data[i] : highest;
    }
    assert(lowest >= model.meanValue - 1e-5f && highest <= model.meanValue + 255.0f * model.imgScale + 1e-5f);
    assert(highest - lowest > 0.9f);
    forwardOpenPose(&model, &tensor, &outputs);
    assert(outputs.channels[0] == model.evenChannelOutput && outputs.channels[1] == model.oddChannelOutput);
    assert(outputs.widths[0] == model.widthOutput && outputs.heights[0] == model.heightOutput);

    loadImage("no/such/picture.jpg", &none);
    assert(none.data == NULL);
    initOpendrTensorFromImgOp(&none, &tensor, &model);
    assert(tensor.data == NULL);
    freeImage(&none);
    loadOpenPoseModel("no/such/model", &missing);
    assert(missing.onnxSession == NULL);
    initOpenDRTensorFromImgOp(&image, &tensor, &missing);
    assert(tensor.data == NULL);
    initRandomOpendrTensorOp(&tensor, &missing);
    assert(tensor.data == NULL);
    freeOpenPoseModel(&missing);

    freeImage(&image);
    freeImage(&image);
    freeTensor(&tensor);
    freeTensorVector(&outputs);
    freeOpenPoseModel(&model);
    freeOpenPoseModel(&model);
    return 0;
}

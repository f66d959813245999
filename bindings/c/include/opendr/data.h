#ifndef OPENDR_DATA_H
#define OPENDR_DATA_H

/* Pictures and tensors by OpenDR's names; opendr_compat.h explains these headers. */

typedef struct OpenDRImage {
    void *data; /* an opendr_image */
} OpenDRImageT;

typedef struct OpenDRTensor {
    int batchSize, frames, channels, width, height;
    float *data; /* height fastest */
} OpenDRTensorT;

typedef struct OpenDRTensorVector {
    int nTensors;
    int *batchSizes, *frames, *channels, *widths, *heights;
    float **datas;
} OpenDRTensorVectorT;

typedef struct OpenDRStringsVector {
    char **data;
    int size;
} OpenDRStringsVectorT;

/* As OpenDR 2 spelt them. */
typedef OpenDRImageT OpendrImageT;
typedef OpenDRTensorT OpendrTensorT;
typedef OpenDRTensorVectorT OpendrTensorVectorT;

#endif /* OPENDR_DATA_H */

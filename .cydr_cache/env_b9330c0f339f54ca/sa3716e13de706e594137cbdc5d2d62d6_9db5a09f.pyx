# cython: language_level=3
# cython: boundscheck=False
# cython: wraparound=False
# cython: initializedcheck=False
# cython: cdivision=True

from cpython.bytearray cimport PyByteArray_AS_STRING
from libc.stdint cimport (
    int8_t,
    int16_t,
    int32_t,
    int64_t,
    uint8_t,
    uint16_t,
    uint32_t,
    uint64_t,
)

import numpy as np

cimport cython
cimport numpy as cnp

from cydr._every_supported_cython cimport (
    DecodedStringCollection,
    ENCAPSULATION_HEADER_SIZE,
    STRING_COLLECTION_MODE_NUMPY,
    advance_boolean_field,
    advance_float32_field,
    advance_float64_field,
    advance_int16_field,
    advance_int32_field,
    advance_int64_field,
    advance_int8_field,
    advance_primitive_array_position,
    advance_primitive_sequence_position,
    advance_string_array_position,
    advance_string_field,
    advance_string_sequence_position,
    advance_uint16_field,
    advance_uint32_field,
    advance_uint64_field,
    advance_uint8_field,
    bool_sequence_ptr,
    float32_sequence_ptr,
    float64_sequence_ptr,
    int16_sequence_ptr,
    int32_sequence_ptr,
    int64_sequence_ptr,
    int8_sequence_ptr,
    read_boolean_field,
    read_float32_field,
    read_float64_field,
    read_int16_field,
    read_int32_field,
    read_int64_field,
    read_int8_field,
    read_primitive_array_object,
    read_primitive_sequence_object,
    read_string_array_object,
    read_string_field,
    read_string_sequence_object,
    read_uint16_field,
    read_uint32_field,
    read_uint64_field,
    read_uint8_field,
    require_consumed,
    require_fixed_length,
    string_collection_length,
    uint16_view_ptr,
    uint32_view_ptr,
    uint64_view_ptr,
    uint8_view_ptr,
    validate_encapsulation_header,
    write_boolean_field,
    write_encapsulation_header,
    write_float32_field,
    write_float64_field,
    write_int16_field,
    write_int32_field,
    write_int64_field,
    write_int8_field,
    write_primitive_array,
    write_primitive_sequence,
    write_string_array,
    write_string_field,
    write_string_sequence,
    write_uint16_field,
    write_uint32_field,
    write_uint64_field,
    write_uint8_field,
)


cpdef Py_ssize_t compute_serialized_size_sa3716e13de706e594137cbdc5d2d62d6(
    int32_t arg_0,
    uint32_t arg_1,
    bytes arg_2,
    uint32_t arg_3,
    uint32_t arg_4,
    bytes arg_5,
    uint8_t arg_6,
    uint32_t arg_7,
    const uint8_t[::1] arg_8,
) except -1:
    cdef Py_ssize_t pos = 0

    pos = advance_int32_field(pos)
    pos = advance_uint32_field(pos)
    pos = advance_string_field(pos, arg_2)
    pos = advance_uint32_field(pos)
    pos = advance_uint32_field(pos)
    pos = advance_string_field(pos, arg_5)
    pos = advance_uint8_field(pos)
    pos = advance_uint32_field(pos)
    pos = advance_primitive_sequence_position(pos, arg_8.shape[0], cython.sizeof(uint8_t), 1)
    return pos + ENCAPSULATION_HEADER_SIZE


cpdef bytearray serialize_sa3716e13de706e594137cbdc5d2d62d6(
    int32_t arg_0,
    uint32_t arg_1,
    bytes arg_2,
    uint32_t arg_3,
    uint32_t arg_4,
    bytes arg_5,
    uint8_t arg_6,
    uint32_t arg_7,
    const uint8_t[::1] arg_8,
):
    cdef Py_ssize_t total_size = compute_serialized_size_sa3716e13de706e594137cbdc5d2d62d6(
        arg_0,
        arg_1,
        arg_2,
        arg_3,
        arg_4,
        arg_5,
        arg_6,
        arg_7,
        arg_8,
    )
    cdef bytearray output = bytearray(total_size)
    cdef unsigned char* buffer = <unsigned char*> PyByteArray_AS_STRING(output)
    cdef unsigned char* payload = buffer + ENCAPSULATION_HEADER_SIZE
    cdef Py_ssize_t pos = 0

    write_encapsulation_header(buffer)

    pos = write_int32_field(payload, pos, arg_0)
    pos = write_uint32_field(payload, pos, arg_1)
    pos = write_string_field(payload, pos, arg_2)
    pos = write_uint32_field(payload, pos, arg_3)
    pos = write_uint32_field(payload, pos, arg_4)
    pos = write_string_field(payload, pos, arg_5)
    pos = write_uint8_field(payload, pos, arg_6)
    pos = write_uint32_field(payload, pos, arg_7)
    pos = write_primitive_sequence(payload, pos, uint8_view_ptr(arg_8), arg_8.shape[0], cython.sizeof(uint8_t), 1)
    return output


cpdef tuple deserialize_sa3716e13de706e594137cbdc5d2d62d6(
    const unsigned char[::1] data,
    int string_collection_mode=STRING_COLLECTION_MODE_NUMPY,
):
    cdef const unsigned char[::1] payload
    cdef Py_ssize_t pos = 0
    cdef int32_t arg_0
    cdef uint32_t arg_1
    cdef bytes arg_2
    cdef uint32_t arg_3
    cdef uint32_t arg_4
    cdef bytes arg_5
    cdef uint8_t arg_6
    cdef uint32_t arg_7
    cdef cnp.ndarray arg_8

    validate_encapsulation_header(data)
    payload = data[ENCAPSULATION_HEADER_SIZE:]

    arg_0 = read_int32_field(payload, &pos)
    arg_1 = read_uint32_field(payload, &pos)
    arg_2 = read_string_field(payload, &pos)
    arg_3 = read_uint32_field(payload, &pos)
    arg_4 = read_uint32_field(payload, &pos)
    arg_5 = read_string_field(payload, &pos)
    arg_6 = read_uint8_field(payload, &pos)
    arg_7 = read_uint32_field(payload, &pos)
    arg_8 = read_primitive_sequence_object(payload, &pos, cython.sizeof(uint8_t), 1, cnp.NPY_UINT8)
    require_consumed(payload, pos)
    return (
        arg_0,
        arg_1,
        arg_2,
        arg_3,
        arg_4,
        arg_5,
        arg_6,
        arg_7,
        arg_8,
    )

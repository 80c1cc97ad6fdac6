// The last connections of a board's top in the boards' benches: a sensor and an image processor, where the bench has them.
`ifdef SENSOR_AT_PINS
, .camera_pixclk(pixclk), .camera_frame_valid(seen_frame), .camera_line_valid(seen_line), .camera_data(seen_data),
    .isp_pixclk(isp_pixclk), .isp_frame_valid(isp_frame_valid), .isp_line_valid(isp_line_valid), .isp_data(isp_data)
`endif

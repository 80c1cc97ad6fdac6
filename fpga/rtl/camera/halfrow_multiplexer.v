// What stands in front of the core and behind it: test frames while a session is open, the sensor otherwise, both
// through the same silicon. At each change the core is emptied for one clock. A burst's frames take the sensor's way
// out.
`default_nettype none

module halfrow_multiplexer #(
    parameter ROW_BITS = 11
) (
    input  wire                clk,
    input  wire                rst,
    input  wire                session_open,
    input  wire                tables_ready, // high once the tables have contents
    input  wire                burst,        // the test frames are a burst's
    output wire                camera_reset, // the sensor is not looked at
    output wire                output_reset, // the image processor sees nothing

    input  wire                test_reset,   // one clock: test rows are dropped
    input  wire                test_enables, // test rows' enable of the next clock
    input  wire                test_prepare,
    input  wire [ROW_BITS-1:0] test_prepare_row,
    input  wire                test_prepare_bank,
    input  wire                test_valid,
    input  wire                test_start,
    input  wire [11:0]         test_sample,
    output wire                test_out_valid,

    input  wire                camera_prepare,
    input  wire [ROW_BITS-1:0] camera_prepare_row,
    input  wire                camera_prepare_bank,
    input  wire                camera_valid,
    input  wire                camera_start,
    input  wire [11:0]         camera_sample,
    output wire                shown_valid,  // an output that the image processor sees

    output wire                core_reset,
    output reg                 core_enable,  // a register, since all of the core hangs on it
    output wire                prepare,
    output wire [ROW_BITS-1:0] prepare_row,
    output wire                prepare_bank,
    output wire                in_valid,
    output wire                in_start,
    output wire [11:0]         in_sample,
    input  wire                out_valid
);
    reg test;
    reg camera; // never high together with `test`
    reg started; // no reset a clock ago; all of the core hangs on its own

    always @(posedge clk)
        if (rst) begin
            test <= 1'b0;
            camera <= 1'b0;
        end else begin
            test <= session_open;
            camera <= !session_open && (camera || tables_ready);
        end

    always @(posedge clk)
        core_enable <= rst || !session_open || test_enables;

    assign camera_reset = rst || !camera || session_open;
    assign output_reset = camera_reset && !burst;
    always @(posedge clk)
        started <= !rst;

    assign core_reset = !started || test_reset || (test != session_open);

    assign prepare = test ? test_prepare : camera_prepare && camera;
    assign prepare_row = test ? test_prepare_row : camera_prepare_row;
    assign prepare_bank = test ? test_prepare_bank : camera_prepare_bank;
    assign in_valid = test ? test_valid : camera_valid && camera;
    assign in_start = test ? test_start : camera_start;
    assign in_sample = test ? test_sample : camera_sample;

    assign test_out_valid = out_valid && test;
    assign shown_valid = out_valid && (!test || burst);
endmodule

`default_nettype wire

// The step table: one factor Q a row and bank, read through one port. A memory's output gets a register of its own
// before anything is made of it, since it comes late in the clock.
`default_nettype none

module halfrow_steps #(
    parameter MAX_HEIGHT = 2048,
    parameter ROW_BITS = 11,
    parameter TABLE_BANKS = 2
) (
    input  wire                clk,
    input  wire                write,
    input  wire                write_bank,
    input  wire [ROW_BITS-1:0] write_row,
    input  wire [24:0]         write_step,
    input  wire                read,
    input  wire                read_bank,
    input  wire [ROW_BITS-1:0] read_row,
    output reg  [24:0]         step, // two clocks behind `read`, until the next one
    output reg                 bank  // that it comes from, one clock behind
);
    // One memory a bank: a single one of twice the depth takes more block RAMs.
    (* ram_style = "block", no_rw_check *) reg [24:0] first [0:MAX_HEIGHT-1];
    reg [24:0] first_step;

    always @(posedge clk) begin
        if (write && !(write_bank && TABLE_BANKS == 2))
            first[write_row] <= write_step;
        if (read)
            first_step <= first[read_row];
    end

    always @(posedge clk)
        if (read)
            bank <= read_bank;

    generate
        if (TABLE_BANKS == 2) begin : two_banks
            (* ram_style = "block", no_rw_check *) reg [24:0] second [0:MAX_HEIGHT-1];
            reg [24:0] second_step;

            always @(posedge clk) begin
                if (write && write_bank)
                    second[write_row] <= write_step;
                if (read)
                    second_step <= second[read_row];
            end

            always @(posedge clk)
                step <= bank ? second_step : first_step;
        end else begin : one_bank
            always @(posedge clk)
                step <= first_step;
        end
    endgenerate
endmodule

`default_nettype wire

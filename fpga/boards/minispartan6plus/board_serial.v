// Reads the 57 bits of the FPGA's own number, once. Their clock may be no faster than 2 MHz; it is link_clk / 64.
`default_nettype none

module board_serial (
    input  wire        link_clk,
    input  wire        link_rst,
    output wire [63:0] serial,
    output reg         ready            // from here on `serial` stands still
);
    reg  [5:0]  phase = 6'd0;           // bit 5 is the number's clock
    reg  [5:0]  count;
    reg  [56:0] bits;
    reg         slow_clock, read, shift;
    wire        bit_out;
    wire        falling = phase == 6'd63;

    DNA_PORT dna (.DOUT(bit_out), .CLK(slow_clock), .DIN(1'b0), .READ(read), .SHIFT(shift));

    always @(posedge link_clk) begin
        phase <= phase + 6'd1;
        slow_clock <= phase[5];
    end

    // One rising edge loads the number and shows its first bit; each bit is taken half a clock before the edge that shifts it out.
    always @(posedge link_clk)
        if (link_rst) begin
            count <= 6'd0;
            read <= 1'b0;
            shift <= 1'b0;
            ready <= 1'b0;
        end else if (falling && !ready) begin
            count <= count + 6'd1;
            read <= count == 6'd0;
            shift <= count != 6'd0;
            ready <= count == 6'd57;
        end

    always @(posedge link_clk)
        if (falling && count != 6'd0 && !ready)
            bits <= {bits[55:0], bit_out};

    assign serial = {7'd0, bits};
endmodule

`default_nettype wire

// A chip that keeps the data sheet's times at their worst, behind pads of 5 ns (6 ns for data, 3 ns for WR#: the bounds of the miniSpartan6+),
// looks whether the other side keeps them: pulses, set-up and hold, no read when empty, no write when full, never two drivers, nothing driven
// that may not be, SIWU# long enough, only when writing has stopped, and then always. Both directions at once, with gaps and stalls, at three clocks.
`default_nettype none

module halfrow_ft245_bench;
    // Times in 0.1 ns.
    localparam PAD = 50, PAD_DATA = 60, PAD_WR = 30;
    localparam PULSE = 300, GOOD_DATA = 140, ANSWER = 140, INACTIVE = 490, SETUP = 50, HOLD = 50, STROBE = 2500;
    localparam BYTES = 120;

    reg        clk, rst, armed, rx_ready, tx_valid;
    reg  [7:0] tx_data;
    wire       rd_n, wr_n, siwu_n, control_drive, data_drive, rx_valid, tx_ready;
    wire [7:0] data_out, rx_data;

    // The chip's pins.
    reg        chip_rxf_n, chip_txe_n, chip_drive;
    reg  [7:0] chip_data;
    wire       #PAD chip_rd_n   = rd_n;
    wire       #PAD_WR chip_wr_n   = control_drive ? wr_n : 1'b1;
    wire       #PAD chip_siwu_n = control_drive ? siwu_n : 1'b1;
    wire       #PAD_DATA from_board  = data_drive;
    wire [7:0] #PAD_DATA bus_out     = data_out;
    wire       #PAD rxf_n       = chip_rxf_n;
    wire       #PAD txe_n       = chip_txe_n;
    wire [7:0] #PAD bus_in      = chip_drive ? chip_data : 8'hxx;

    halfrow_ft245 dut (
        .clk(clk), .rst(rst), .armed(armed), .ft_rxf_n(rxf_n), .ft_txe_n(txe_n), .ft_rd_n(rd_n), .ft_wr_n(wr_n),
        .ft_siwu_n(siwu_n), .ft_control_drive(control_drive), .ft_data_in(bus_in), .ft_data_out(data_out),
        .ft_data_drive(data_drive), .rx_valid(rx_valid), .rx_data(rx_data), .rx_ready(rx_ready), .tx_valid(tx_valid),
        .tx_data(tx_data), .tx_ready(tx_ready)
    );

    integer half, gaps, stalls, seed, faults, given, got, sent, taken, unsent, n;
    integer rd_fell, wr_fell, siwu_fell, data_changed, wr_rose, began;
    integer finished;  // bytes of the slower direction when the faster one had all
    reg     trap;

    initial begin
        clk = 0;
        forever #half clk = ~clk;
    end

    task fault(input [8*40-1:0] what);
        begin
            faults = faults + 1;
            $display("FAIL half %0d, gaps %0d, stalls %0d: %0s at %0d read, %0d written", half, gaps, stalls, what, got, taken);
            if (faults > 20) $finish;
        end
    endtask

    function [7:0] word(input integer place);
        word = place * 151 + (place >> 8);
    endfunction

    function integer up_to(input integer most);
        up_to = $unsigned($random(seed)) % (most + 1);
    endfunction

    // How long a direction of the chip has nothing to give, or no room.
    function integer wait_of(input integer pattern, input integer place);
        case (pattern)
            0:       wait_of = 0;
            1:       wait_of = up_to(2000);
            2:       wait_of = up_to(30000);
            default: wait_of = place % 50 == 0 ? 100000 : 0;
        endcase
    endfunction

    // Reading.
    always @(negedge chip_rd_n) begin
        if (chip_rxf_n && !rst) fault("read when empty");
        if (from_board) fault("read while the board drives");
        rd_fell    = $time;
        chip_data  = 8'hxx;
        chip_drive = 1;
        #GOOD_DATA chip_data = word(given);
    end
    always @(posedge chip_rd_n) if (!rst) begin : after_read
        if ($time - rd_fell < PULSE) fault("RD# too short");
        chip_data = 8'hxx;
        given     = given + 1;
        #(1 + up_to(ANSWER - 1)) chip_drive = 0;
        if (!trap) begin
            chip_rxf_n = 1;
            #(INACTIVE + wait_of(gaps, given)) if (given < BYTES) chip_rxf_n = 0;
        end
    end

    // Writing.
    always @(bus_out or from_board) begin
        if (from_board && $time - wr_rose < HOLD) fault("data did not hold");
        if (from_board && !chip_wr_n) fault("data changes under WR#");
        data_changed = $time;
    end
    always @(negedge from_board) #1 if ($time - wr_rose <= HOLD || !chip_wr_n) fault("data did not hold");
    always @(negedge chip_wr_n) begin
        if (chip_txe_n) fault("written when full");
        if (!from_board || $time - data_changed < SETUP) fault("no set-up");
        if (bus_out !== word(taken)) fault("wrong byte written");
        if (!chip_siwu_n) fault("written under SIWU#");
        wr_fell = $time;
    end
    always @(posedge chip_wr_n) if (!rst) begin : after_write
        wr_rose = $time;
        if ($time - wr_fell < PULSE) fault("WR# too short");
        taken  = taken + 1;
        unsent = unsent + 1;
        #(1 + up_to(ANSWER - 1)) chip_txe_n = 1;
        #(INACTIVE + wait_of(stalls, taken)) chip_txe_n = 0;
    end
    always @(negedge chip_siwu_n) begin
        if (unsent == 0) fault("SIWU# without need");
        if ($time - wr_rose < 50000) fault("SIWU# between bytes");
        unsent    = 0;
        siwu_fell = $time;
    end
    always @(posedge chip_siwu_n) if (!rst && $time - siwu_fell < STROBE) fault("SIWU# too short");

    always @(posedge clk) begin
        if (chip_drive && from_board) fault("two drivers");
        if (!armed && data_drive && !rst) fault("data driven unarmed");
    end

    // The board's side.
    function pause(input integer pattern, input integer place);
        case (pattern)
            0:       pause = 0;
            1:       pause = $random(seed);
            2:       pause = up_to(63) != 0;
            default: pause = ($time >> 16) & 1;
        endcase
    endfunction

    always @(posedge clk) if (!rst) begin
        if (rx_valid && rx_ready) begin
            if (rx_data !== word(got)) fault("wrong byte read");
            got = got + 1;
        end
        if (finished == 0 && (got == BYTES || taken == BYTES)) finished = got == BYTES ? taken : got;
        if (tx_valid && tx_ready) sent = sent + 1;
        #1 rx_ready = !pause(stalls, got);
        if (!tx_valid || sent != n) begin
            n        = sent;
            tx_valid = sent < BYTES && !pause(gaps, sent);
            tx_data  = tx_valid ? word(sent) : 8'hxx;
        end
    end

    task reset_all;
        begin
            rst = 1;
            {given, got, sent, taken, unsent, finished, n} = 0;
            {wr_rose, data_changed} = 0;
            {chip_rxf_n, chip_txe_n, chip_drive, tx_valid, armed, rx_ready} = 6'b110000;
            tx_data = 8'hxx;
            repeat (1300) @(posedge clk);
            #1 rst = 0;
        end
    endtask

    task wait_for_bytes;
        begin
            began = $time;
            while ((got < BYTES || taken < BYTES) && $time - began < 200000000) @(posedge clk) #2;
            if (gaps == 0 && stalls == 0)
                $display("PASS half %0d: %0d ns for a byte each way", half, ($time - began) / BYTES / 10);
            repeat (1100) @(posedge clk) #2;
            if (got != BYTES || taken != BYTES || rx_valid) fault("bytes missing or too many");
            if (unsent != 0) fault("bytes not sent off");
            if (gaps == 0 && stalls == 0 && finished < BYTES - 30) fault("one side starves");
        end
    endtask

    initial begin
        {seed, faults, gaps, stalls, half} = {32'd1, 32'd0, 32'd0, 32'd0, 32'd50};
        trap = 0;
        for (half = 50; half <= 170; half = half + (half == 50 ? 2 : 118)) begin
            for (gaps = 0; gaps < 4; gaps = gaps + 1)
                for (stalls = 0; stalls < 4; stalls = stalls + 1) begin
                    reset_all;
                    chip_txe_n = 0;
                    repeat (100) @(posedge clk) #2 if (control_drive || data_drive) fault("driven unarmed");
                    armed      = 1;
                    chip_rxf_n = 0;
                    wait_for_bytes;
                end
            if (faults == 0) $display("PASS half %0d: %0d bytes each way under 16 mixes of gaps and stalls", half, BYTES);

            // A chip that is set up as a UART seems to have bytes for ever and no room, and drives WR# and SIWU# itself.
            {gaps, stalls} = 0;
            trap           = 1;
            reset_all;
            chip_rxf_n = 0;
            repeat (4000) @(posedge clk) #2 if (control_drive || data_drive) fault("driven into a UART");
            chip_rxf_n = 1;
            repeat (30) @(posedge clk);
            trap = 0;
            if (got < 100 || sent != 0) fault("trap");
            if (faults == 0) $display("PASS half %0d: nothing driven into a UART", half);
        end
        $display("DONE");
        $finish;
    end
endmodule

`default_nettype wire
